(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker accepts of motions that lead to stated poses is true *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Loads Turns Checker Enclosure Machine Poses.
Import ListNotations.
Open Scope R_scope.

Module Motions (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module P := Poses.Poses F.
Import P P.N P.N.C.

Section Precision.

Variable prec : F.precision.

Lemma point_is_in u i : is_in (coordinate u i) (point prec u i).
Proof.
  unfold coordinate, point. destruct (nth i u (0%Q, 0%Z)) as [q h].
  apply add_is_in; [apply fraction_is_in |]. apply mul_is_in; [apply integer_is_in | apply I.pi_correct].
Qed.

(** Parameters, or poses, that move, and what the checker has of them. *)
Definition parameters_follow (f : parameters_form) (q : R -> nat -> R) : Prop :=
  forall middle s m S t, is_in middle m -> is_in middle S -> is_in s S -> of_place t = s - middle ->
  forall i, encloses t (f m S i) (q middle i) (q s i).
Definition follows (f : poses_form) (q : R -> pose) : Prop :=
  forall middle s m S t, is_in middle m -> is_in middle S -> is_in s S -> of_place t = s - middle ->
  is_turn (f m S) = true ->
  is_rigid (q middle) /\ is_rigid (q s) /\ pose_encloses t (f m S) (q middle) (q s).

Lemma posed_follows m f q : parameters_follow f q -> follows (fun x S => posed prec m (f x S)) (fun s =>
  pose_at m (q s)).
Proof.
  intros h middle s x S t hm hm' hs ht turns. cbn [posed is_turn] in turns.
  split; [now apply angles_are_rigid | split; [now apply angles_are_rigid |]]. now apply posed_encloses, h.
Qed.

Lemma place_encloses middle s m S t : is_in middle m -> is_in middle S -> is_in s S -> of_place t = s - middle ->
  encloses t (Form m S (one prec) []) middle s.
Proof.
  intros hm hm' hs ht. split; [exact hm | split; [exact hm' | split; [exact hs |]]]. cbn [slope].
  exists (k_place 1). split; [exact (conj (integer_is_in prec 1) no_blocks) |].
  unfold sloped. rewrite moved_place, ht. ring.
Qed.

Lemma line_follows v w : parameters_follow (line_form prec v w) (on_line v w).
Proof.
  intros middle s m S t hm hm' hs ht i. unfold on_line, line_form. cbv zeta.
  assert (a := point_is_in v i). assert (k := sub_is_in prec _ _ _ _ (point_is_in w i) a).
  split; [| split; [| split]]; cbn [mid over slope].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - exists (k_place (coordinate w i - coordinate v i)). split; [exact (conj k no_blocks) |].
    unfold sloped. rewrite moved_place, ht. ring.
Qed.

Lemma spline_follows a b c d : parameters_follow (spline_form prec a b c d) (on_spline a b c d).
Proof.
  intros middle s m S t hm hm' hs ht i.
  set (A := coordinate a i). set (B := coordinate b i). set (C := coordinate c i). set (D := coordinate d i).
  assert (powers : forall x, on_spline a b c d x i =
    (B + (C - B - (B - A)) / 6) + x * ((B - A + (C - B)) / 2 + x * ((C - B - (B - A)) / 2 +
      x * ((D - C - 2 * (C - B) + (B - A)) / 6)))) by (intros x; unfold on_spline; fold A B C D; field).
  rewrite !powers. unfold spline_form. cbv zeta.
  assert (hA := point_is_in a i). assert (hB := point_is_in b i). assert (hC := point_is_in c i).
  assert (hD := point_is_in d i). fold A in hA. fold B in hB. fold C in hC. fold D in hD.
  assert (two := integer_is_in prec 2). assert (six := integer_is_in prec 6).
  assert (here := place_encloses _ _ _ _ t hm hm' hs ht).
  repeat first [apply add_encloses | (apply mul_encloses; [exact here |])];
    apply constant_encloses; repeat first [assumption | apply add_is_in | apply sub_is_in | apply mul_is_in
      | apply div_is_in].
Qed.

Lemma without_half_turns w i : no_half_turns w = true -> coordinate w i = Q2R (coordinate_q w i).
Proof.
  unfold no_half_turns, coordinate, coordinate_q. intros h. rewrite forallb_forall in h.
  assert (z : snd (nth i w (0%Q, 0%Z)) = 0%Z).
  { destruct (nth_in_or_default i w (0%Q, 0%Z)) as [l | e]; [| now rewrite e]. apply h, Z.eqb_eq in l. now symmetry. }
  destruct (nth i w (0%Q, 0%Z)) as [q z']. cbn [snd fst] in *. rewrite z. ring.
Qed.

Lemma quaternion_is_rational w : no_half_turns w = true ->
  quaternion_of w = Quaternion (real_vec (vector_q w)) (Q2R (coordinate_q w 6)).
Proof. intros h. unfold quaternion_of. now rewrite !(without_half_turns w) by exact h. Qed.

Lemma between_is_rational v w : no_half_turns v = true -> no_half_turns w = true ->
  between (quaternion_of v) (quaternion_of w) = Quaternion (real_vec (fst (between_q v w))) (Q2R (snd (between_q v w))).
Proof.
  intros a b. rewrite !quaternion_is_rational by assumption.
  unfold between, between_q, dot_q, real_vec, minus, times, cross, dot. cbn [vector_part scalar_part fst snd vx vy vz].
  f_equal; [f_equal |]; repeat first [rewrite Q2R_plus | rewrite Q2R_minus | rewrite Q2R_mult]; reflexivity.
Qed.

(** Where the turns are the same, a geodesic does not turn. *)
Lemma no_turn u c s x : real_vec u = Vec 0 0 0 ->
  turn_about (unit_along (real_vec u)) (s * (2 * atan (norm (real_vec u) / c))) x = x.
Proof.
  intros ->. rewrite norm_of_zero. replace (0 / c) with 0 by (unfold Rdiv; ring). rewrite atan_0.
  replace (s * (2 * 0)) with 0 by ring. apply turn_about_by_nothing.
Qed.

Lemma geodesic_follows v w : follows (geodesic_form prec v w) (on_geodesic v w).
Proof.
  intros middle s m S t hm hm' hs ht turns. unfold geodesic_form in *.
  destruct (between_q v w) as [u c] eqn:eq. cbn [is_turn] in turns. unfold turns_meet in turns. rewrite eq in turns.
  cbn [snd] in turns. rewrite !andb_true_iff, negb_true_iff in turns.
  destruct turns as [[hv hw] hc].
  assert (rel := between_is_rational v w hv hw). rewrite eq in rel. cbn [fst snd] in rel.
  assert (c_not_0 : Q2R c <> 0).
  { intros z. assert (Qeq_bool c 0 = true); [| congruence]. apply Qeq_bool_iff, eqR_Qeq. rewrite z. unfold Q2R. cbn.
    lra. }
  assert (sq : square (quaternion_of v) <> 0).
  { apply (squares_are_not_0 _ (quaternion_of w)). now rewrite rel. }
  unfold on_geodesic. rewrite rel. cbn [vector_part scalar_part].
  assert (still : is_vector u = false -> real_vec u = Vec 0 0 0).
  { unfold is_vector. rewrite negb_false_iff, !andb_true_iff. intros [[x y] z]. unfold real_vec.
    now rewrite (zero_of _ x), (zero_of _ y), (zero_of _ z). }
  assert (rigid : forall x P, is_rigid (Pose P (fun y => turn_by (quaternion_of v)
      (turn_about (unit_along (real_vec u)) (x * (2 * atan (norm (real_vec u) / Q2R c))) y)))).
  { intros x P. split; cbn [turn].
    - intros y. rewrite (turn_about_axis_is_linear _ _ y). apply turn_by_is_linear.
    - intros y z. rewrite turn_by_keeps_dot by exact sq. destruct (is_vector u) eqn:moves.
      + apply turn_about_keeps_dot, unit_along_is_unit. now apply vector_is_not_0.
      + now rewrite !no_turn by now apply still. }
  split; [apply rigid | split; [apply rigid |]].
  assert (line := line_follows v w middle s m S t hm hm' hs ht). split; cbn [position turn place images].
  - split; [| split]; cbn [vx vy vz]; apply line.
  - apply columns_of_encloses. intros V x e. rewrite quaternion_is_rational by exact hv.
    apply turn_by_encloses; [apply v_rational_encloses | apply constant_encloses, fraction_is_in |].
    destruct (is_vector u) eqn:moves; [| now rewrite !no_turn by now apply still].
    apply turn_about_encloses; [apply unit_encloses | | exact e].
    apply mul_encloses; [now apply place_encloses |]. apply constant_encloses.
      apply mul_is_in; [apply (integer_is_in prec 2) |].
    apply atan_is_in, div_is_in; [apply norm_of_is_in, fractions_are_in | apply fraction_is_in].
Qed.

Lemma chord_follows v w : follows (chord_form prec v w) (on_chord v w).
Proof.
  intros middle s m S t hm hm' hs ht turns. unfold chord_form in *. cbn [is_turn] in turns.
  assert (line := line_follows v w middle s m S t hm hm' hs ht).
  set (q := fun s => Quaternion (Vec (on_line v w s 3) (on_line v w s 4) (on_line v w s 5)) (on_line v w s 6)).
  set (x := line_form prec v w m S) in *.
  assert (u : v_encloses t (Vec (x 3%nat) (x 4%nat) (x 5%nat)) (vector_part (q middle)) (vector_part (q s)))
    by (split; [| split]; apply line).
  assert (sq : encloses t (f_add prec (v_dot prec (Vec (x 3%nat) (x 4%nat) (x 5%nat)) (Vec (x 3%nat) (x 4%nat) (x
    5%nat)))
    (f_mul prec (x 6%nat) (x 6%nat))) (square (q middle)) (square (q s)))
    by (apply add_encloses; [now apply v_dot_encloses | apply mul_encloses; apply line]).
  destruct sq as [_ [sm [ss _]]].
  assert (rigid : forall p (r : quaternion), square r <> 0 -> is_rigid (Pose p (turn_by r))).
  { intros p r h. split; cbn [turn]; [apply turn_by_of_units | intros a b; now apply turn_by_keeps_dot]. }
  split; [apply rigid, (apart0_is_true _ _ turns sm) | split; [apply rigid, (apart0_is_true _ _ turns ss) |]].
  split; cbn [position turn place images]; [split; [| split]; cbn [vx vy vz]; apply line |].
  apply columns_of_encloses. intros V a e. apply turn_by_encloses; [exact u | apply line | exact e].
Qed.

(** ** Boxes *)

Section Certificate.

Variable c : certificate.

(** How a machine deviates at a place: by these vectors. *)
Definition change_of (m : machine) (place : R) (B : built) (off axis : vec R) (angle : R) : change :=
  let at_base i := minus (fst (nth6 (anchors B) i)) (real_vec (base (nth6 (cables m) i))) in
  let at_platform i := minus (snd (nth6 (anchors B) i)) (real_vec (platform (nth6 (cables m) i))) in
  Change place (fun b => nth b
    [off; moves_about axis angle; minus (load_at B) (real_vec (load_point m));
     at_base 0%nat; at_platform 0%nat; at_base 1%nat; at_platform 1%nat; at_base 2%nat; at_platform 2%nat;
     at_base 3%nat; at_platform 3%nat; at_base 4%nat; at_platform 4%nat; at_base 5%nat; at_platform 5%nat] (Vec 0 0 0)).

Lemma deviations_are_within m place B off axis angle : is_built m B -> norm off <= of_position (tolerance m) ->
  norm axis = 1 -> Rabs angle <= Rabs (value (fun _ => 0) (of_orientation (tolerance m))) ->
  deviates_within (of_ball (change_of m place B off axis angle)) balls (radii prec m).
Proof.
  intros hb ho hn ha. assert (near_i := anchors_are_near m B hb). destruct hb as [_ hp].
  assert (of_turn : exists r, norm (moves_about axis angle) <= r /\ is_in r (angle_of prec m)).
  { eexists. split; [| apply (angle_is_in prec (k_place 0))]. unfold moves_about. rewrite norm_of_times, hn, Rmult_1_r.
    exact (Rle_trans _ _ _ (sin_is_below angle) ha). }
  assert (stated : forall u q, norm u <= Q2R q -> exists r, norm u <= r /\ is_in r (fraction prec q)).
  { intros u q h. exists (Q2R q). split; [exact h | apply fraction_is_in]. }
  intros b lt. unfold balls in lt.
  do 15 (destruct b as [| b]; [cbn [of_ball change_of nth radii];
    first [exact of_turn | apply stated; first [exact ho | exact hp |
      apply (near_i 0%nat); lia | apply (near_i 1%nat); lia | apply (near_i 2%nat); lia |
      apply (near_i 3%nat); lia | apply (near_i 4%nat); lia | apply (near_i 5%nat); lia]] |]).
  lia.
Qed.

Section Motion.

Variables (m : machine) (f : poses_form) (q : R -> pose).
Hypothesis turns_little : below prec (angle_of prec m) (one prec) = true.
Hypothesis f_follows : follows f q.

Lemma angle_is_below_1 : Rabs (value (fun _ => 0) (of_orientation (tolerance m))) < 1.
Proof.
  eapply below_is_true; [exact turns_little | apply (angle_is_in prec (k_place 0)) | apply (integer_is_in prec 1)].
Qed.

(** The places in a box. *)
Lemma places_are_in start b s : Q2R start <= s <= Q2R (upto b) ->
  exists middle, is_in middle (middle_of prec start b) /\ is_in middle (range_of prec start b) /\
    is_in s (range_of prec start b).
Proof.
  intros [l u]. exists (Q2R (Qred ((start + upto b) * (1 # 2)))). unfold range_of, middle_of.
  split; [apply fraction_is_in | split; [apply join_right, fraction_is_in |]].
  apply join_left. unfold from_to. apply (between_is_in (Q2R start) (Q2R (upto b))).
  - apply join_left, fraction_is_in.
  - apply join_right, fraction_is_in.
  - rewrite Rmin_left, Rmax_right by lra. lra.
Qed.

Theorem poses_are_sound start b : check_poses prec c m f start b = true ->
  forall s, Q2R start <= s <= Q2R (upto b) -> forall B P, is_built m B -> is_tracked m (q s) P ->
  feasible_at m B (tension_margin c) (length_margin c) P.
Proof.
  unfold check_poses. cbv zeta. intros h s hs.
  destruct (places_are_in start b s hs) as [middle [hm [hm' hS]]].
  set (x := middle_of prec start b) in *. set (S := range_of prec start b) in *.
  intros B P hb [off [n [angle [ho [hn [ha ->]]]]]].
  set (t := change_of m (s - middle) B off n angle).
  destruct (f_follows _ _ _ _ t hm hm' hS eq_refl (check_pose_turns _ _ _ _ _ _ _ h)) as [rm [rs forms]].
  refine (pose_is_sound prec t (sub prec S x, radii prec m) _ _ eq_refl
    (deviations_are_within _ _ _ _ _ _ hb ho hn ha) (q middle) (q s) _ rm rs forms m B off n angle hn ha
    angle_is_below_1 eq_refl eq_refl eq_refl _ _ ho hb _ _ b h).
  - cbn [fst]. replace 0 with (middle - middle) by ring. now apply sub_is_in.
  - cbn [fst]. now apply sub_is_in.
  - apply each_of_six; reflexivity.
  - apply each_of_six; reflexivity.
Qed.

End Motion.
End Certificate.
End Precision.
End Motions.
