(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker accepts of lengths that are held is true: there is one pose near the chord that has them *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List FunctionalExtensionality.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Loads Turns Checker Enclosure Machine Contraction Poses Motions.
Import ListNotations.
Open Scope R_scope.

Definition half : R := Q2R (1 # 2).

(** A pose in the tube, by its six coordinates. *)
Definition first3 (z : nat -> R) : vec R := Vec (z 0%nat) (z 1%nat) (z 2%nat).
Definition last3 (z : nat -> R) : vec R := Vec (z 3%nat) (z 4%nat) (z 5%nat).
Definition tube_pose (v : waypoint) (P : pose) (z : nat -> R) : pose :=
  Pose (plus (position P) (times (coordinate v 13) (first3 z)))
       (fun u => turn_by (Quaternion (times (coordinate v 14) (last3 z)) 1) (turn P u)).

Definition cable_of (m : machine) (P : pose) (i : nat) : vec R := cable_vector P (nth6 (anchors (itself m)) i).
Definition excess (m : machine) (L : nat -> R) (P : pose) (i : nat) : R :=
  half * (dot (cable_of m P i) (cable_of m P i) - L i * L i).

Lemma excess_is_0 m L P i : 0 < L i -> (excess m L P i = 0 <-> norm (cable_of m P i) = L i).
Proof.
  intros pos. unfold excess, half. replace (Q2R (1 # 2)) with (1 / 2) by (unfold Q2R; cbn; lra). rewrite dot_is_square.
  assert (n := norm_is_positive (cable_of m P i)). split; intros h; [| rewrite h; ring]. nra.
Qed.

Lemma has_lengths_each m L P : has_lengths m L P <-> forall i, (i < 6)%nat -> norm (cable_of m P i) = nth6 L i.
Proof.
  unfold has_lengths, all6, fold6, zip6, cable_of, cable_length. cbn [at1 at2 at3 at4 at5 at6]. split.
  - intros h. decompose [and] h. apply each_of_six; assumption.
  - intros h. repeat split; first [apply (h 0%nat); lia | apply (h 1%nat); lia | apply (h 2%nat); lia |
      apply (h 3%nat); lia | apply (h 4%nat); lia | apply (h 5%nat); lia].
Qed.

Lemma turn_by_nothing k u : turn_by (Quaternion (times k (Vec 0 0 0)) 1) u = u.
Proof. destruct u as [x y z]. unfold turn_by, plus, times, cross, dot. cbn. f_equal; field. Qed.

Definition of_vecs (y z : vec R) (i : nat) : R :=
  match i with 0%nat => vx y | 1%nat => vy y | 2%nat => vz y | 3%nat => vx z | 4%nat => vy z | _ => vz z end.

Lemma tube_pose_of_vecs v P y z : tube_pose v P (of_vecs y z) = Pose (plus (position P) (times (coordinate v 13) y))
  (fun u => turn_by (Quaternion (times (coordinate v 14) z) 1) (turn P u)).
Proof. destruct y, z. reflexivity. Qed.

Lemma in_box_of_vecs y z : in_box (of_vecs y z) <-> in_unit_box y /\ in_unit_box z.
Proof.
  split.
  - intros h. split; (split; [| split]); first [exact (h 0%nat ltac:(lia)) | exact (h 1%nat ltac:(lia)) |
      exact (h 2%nat ltac:(lia)) | exact (h 3%nat ltac:(lia)) | exact (h 4%nat ltac:(lia))
        | exact (h 5%nat ltac:(lia))].
  - intros [[a [b c]] [d [e f]]]. unfold in_box. apply each_of_six; assumption.
Qed.

Lemma same_coordinates v P z z' : (forall i, (i < 6)%nat -> z i = z' i) -> tube_pose v P z = tube_pose v P z'.
Proof. intros h. unfold tube_pose, first3, last3. now rewrite !h by lia. Qed.

(** ** A platform in the tube is off by little *)

Lemma norm_is_small u e : Rabs (vx u) <= e -> Rabs (vy u) <= e -> Rabs (vz u) <= e -> norm u <= 7 / 4 * e.
Proof.
  destruct u as [x y z]. cbn [vx vy vz]. intros a b c. assert (p : 0 <= e) by (apply Rle_trans with (2 := a);
    apply Rabs_pos).
  rewrite <- (Rabs_pos_eq (norm _)) by apply norm_is_positive. apply abs_below; [lra |]. rewrite <- dot_is_square.
  unfold dot. cbn [vx vy vz].
  assert (sq : forall q, Rabs q <= e -> q * q <= e * e).
  { intros q h. rewrite <- (Rabs_pos_eq e p) in h. apply Rsqr_le_abs_1 in h. exact h. }
  assert (h1 := sq x a). assert (h2 := sq y b). assert (h3 := sq z c). nra.
Qed.

Lemma atan_is_below x : 0 <= x -> 0 <= atan x <= x.
Proof.
  intros h. destruct (Req_dec x 0) as [-> | n]; [rewrite atan_0; lra |].
  destruct (MVT_cor2 atan (fun y => / (1 + y ^ 2)) 0 x ltac:(lra)) as [y [e _]]; [intros y _;
    apply derivable_pt_lim_atan |].
  rewrite atan_0 in e. assert (p : 0 < 1 + y ^ 2) by nra. assert (i := Rinv_0_lt_compat _ p).
  assert (o : / (1 + y ^ 2) <= 1) by (rewrite <- Rinv_1; apply Rinv_le_contravar; nra). nra.
Qed.

Lemma norm_of_cross u v : norm (cross u v) <= norm u * norm v.
Proof.
  assert (p := norm_is_positive (cross u v)). rewrite <- (Rabs_pos_eq _ p).
  apply abs_below; [apply Rmult_le_pos; apply norm_is_positive |].
  assert (l := lagrange u v). rewrite !dot_is_square in l. rewrite <- (dot_is_square (cross u v)), dot_is_square.
  assert (0 <= dot u v * dot u v) by apply Rle_0_sqr. nra.
Qed.

(** Between quaternions with the scalar part 1 and small vector parts, the turn is by no more than three times their
    difference. *)
Lemma small_turn_between v w : norm v <= 7 / 32 -> norm w <= 7 / 32 -> exists n angle,
  norm n = 1 /\ Rabs angle <= 3 * norm (minus w v) /\
  forall u, turn_by (Quaternion w 1) u = turn_about n angle (turn_by (Quaternion v 1) u).
Proof.
  intros hv hw. set (q := onward (Quaternion v 1) (Quaternion w 1)).
  assert (pv := norm_is_positive v). assert (pw := norm_is_positive w). assert (pd := norm_is_positive (minus w v)).
  assert (sq : forall y, square (Quaternion y 1) <> 0).
  { intros y. assert (h := square_is_positive (Quaternion y 1)). cbn [scalar_part] in h. lra. }
  assert (eq : forall u, turn_by (Quaternion w 1) u = turn_by q (turn_by (Quaternion v 1) u))
    by (intros u; symmetry; now apply turn_by_onward).
  assert (scalar : 1 - 49 / 1024 <= scalar_part q).
  { unfold q, onward. cbn [vector_part scalar_part]. assert (h := dot_is_below w v).
    assert (b : norm w * norm v <= 7 / 32 * (7 / 32)) by (apply Rmult_le_compat; lra).
    unfold Rabs in h. destruct (Rcase_abs (dot w v)); lra. }
  assert (vector : norm (vector_part q) <= norm (minus w v) * (1 + 7 / 32)).
  { replace (vector_part q) with (plus (minus w v) (times (- 1) (cross (minus w v) v))).
    - apply Rle_trans with (1 := norm_of_plus _ _). rewrite norm_of_times.
      replace (Rabs (- 1)) with 1 by (unfold Rabs; destruct (Rcase_abs (- 1)); lra).
      assert (c := norm_of_cross (minus w v) v).
      assert (norm (minus w v) * norm v <= norm (minus w v) * (7 / 32)) by (apply Rmult_le_compat_l; lra). lra.
    - unfold q, onward. destruct v as [a b c], w as [e f g]. unfold plus, minus, times, cross. cbn. f_equal; ring. }
  assert (positive : scalar_part q <> 0) by lra.
  destruct (Req_dec (norm (vector_part q)) 0) as [z | n].
  - exists (Vec 1 0 0), 0. split; [unfold norm, dot; cbn; replace (_ + _) with 1 by ring; apply sqrt_1 |].
    split; [rewrite Rabs_R0; lra |]. intros u. rewrite eq, turn_about_by_nothing.
    rewrite <- (turn_about_is_turn_by q _ positive), z. unfold Rdiv. rewrite Rmult_0_l, atan_0, Rmult_0_r.
    apply turn_about_by_nothing.
  - exists (unit_along (vector_part q)), (2 * atan (norm (vector_part q) / scalar_part q)). split; [| split].
    + apply unit_along_is_unit. intros e. apply n. rewrite e. apply norm_of_zero.
    + assert (p := norm_is_positive (vector_part q)).
      assert (r : 0 <= norm (vector_part q) / scalar_part q <= 3 / 2 * norm (minus w v)).
      { split; [apply Rmult_le_pos; [exact p | left; apply Rinv_0_lt_compat; lra] |].
        apply Rmult_le_reg_r with (scalar_part q); [lra |]. unfold Rdiv at 1. rewrite Rmult_assoc, Rinv_l by lra. nra. }
      assert (h := atan_is_below _ (proj1 r)). rewrite Rabs_pos_eq; lra.
    + intros u. rewrite eq. symmetry. now apply turn_about_is_turn_by.
Qed.

Lemma six_choices {A : Type} (P : nat -> A -> Prop) : (forall i, (i < 6)%nat -> exists a, P i a) ->
  exists f, forall i, (i < 6)%nat -> P i (f i).
Proof.
  intros h. destruct (h 0%nat ltac:(lia)) as [a0 h0]. destruct (h 1%nat ltac:(lia)) as [a1 h1].
  destruct (h 2%nat ltac:(lia)) as [a2 h2]. destruct (h 3%nat ltac:(lia)) as [a3 h3].
  destruct (h 4%nat ltac:(lia)) as [a4 h4]. destruct (h 5%nat ltac:(lia)) as [a5 h5].
  exists (fun i => match i with 0%nat => a0 | 1%nat => a1 | 2%nat => a2 | 3%nat => a3 | 4%nat => a4 | _ => a5 end).
  apply each_of_six; assumption.
Qed.

Module Tubes (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module M := Motions.Motions F.
Import M M.P M.P.N M.P.N.C.

Section Precision.

Variable prec : F.precision.

Lemma turned_images_enclose t R f f' U u u' : images_enclose t R f f' ->
  (forall a, f a = combination a (f unit_x) (f unit_y) (f unit_z)) ->
  (forall a, f' a = combination a (f' unit_x) (f' unit_y) (f' unit_z)) ->
  v_encloses t U u u' -> v_encloses t (turned prec R U) (f u) (f' u').
Proof.
  intros [x [y z]] l l' h. destruct h as [hx [hy hz]]. rewrite l, (l' u'). unfold turned, combination.
  repeat first [apply v_add_encloses | apply v_scale_encloses; assumption].
Qed.

(** Coordinates in a tube. *)
Lemma scaled_encloses t q V u u' : v_encloses t V u u' ->
  v_encloses t (scaled prec q V) (times (Q2R q) u) (times (Q2R q) u').
Proof. intros h. apply v_scale_encloses; [apply constant_encloses, fraction_is_in | exact h]. Qed.

Lemma shift_encloses t v V u u' : no_half_turns v = true -> v_encloses t V u u' ->
  v_encloses t (shift_form prec v V) (times (coordinate v 13) u) (times (coordinate v 13) u').
Proof. intros r. rewrite (without_half_turns v) by exact r. apply scaled_encloses. Qed.

Lemma tube_turn_encloses t v Y y y' V u u' : no_half_turns v = true -> v_encloses t Y y y' -> v_encloses t V u u' ->
  v_encloses t (tube_turn prec v Y V) (turn_by (Quaternion (times (coordinate v 14) y) 1) u)
    (turn_by (Quaternion (times (coordinate v 14) y') 1) u').
Proof.
  intros r hy hv. rewrite (without_half_turns v) by exact r.
  apply turn_by_encloses; [now apply scaled_encloses | apply one_encloses | exact hv].
Qed.

Section Tube.

Variables (m : machine) (v w : waypoint) (x S : interval) (middle s : R).
Hypotheses (middle_in_x : is_in middle x) (middle_in_S : is_in middle S) (s_in : is_in s S)
  (v_is_rational : no_half_turns v = true).

Let L (i : nat) : R := on_line v w s (7 + i).
Let chord := on_chord v w.
Let chord_box := chord_form prec v w x S.
Let g (z : nat -> R) : nat -> R := excess m L (tube_pose v (chord s) z).

(** *** Along s, in the middle of the tube *)

Let along : change := Change (s - middle) (fun _ => Vec 0 0 0).
Hypothesis turns : is_turn (chord_form prec v w x S) = true.

Lemma along_is_in : is_in (of_place along) (fst (tube_reach prec x S)).
Proof. cbn. now apply sub_is_in. Qed.

Lemma along_has_0 : is_in 0 (fst (tube_reach prec x S)).
Proof. cbn [tube_reach fst]. replace 0 with (middle - middle) by ring. now apply sub_is_in. Qed.

Lemma along_is_within : deviates_within (of_ball along) balls (snd (tube_reach prec x S)).
Proof.
  intros b l. exists 0. split; [cbn; rewrite norm_of_zero; lra |]. cbn [tube_reach snd].
  rewrite nth_repeat_below by exact l. apply (integer_is_in prec 0).
Qed.

Notation tight_enc := (v_tight_encloses prec along (tube_reach prec x S) along_has_0 along_is_in eq_refl
  along_is_within).

Lemma chord_is_enclosed : is_rigid (chord middle) /\ is_rigid (chord s) /\
  pose_encloses along (chord_form prec v w x S) (chord middle) (chord s).
Proof. exact (chord_follows prec v w middle s x S along middle_in_x middle_in_S s_in eq_refl turns). Qed.

Lemma arm_is_enclosed c : v_encloses along (arm_range prec x S chord_box c)
  (turn (chord middle) (real_vec (platform c))) (turn (chord s) (real_vec (platform c))).
Proof.
  destruct chord_is_enclosed as [[lm _] [[ls _] [_ h]]]. unfold arm_range. apply tight_enc.
  apply turned_images_enclose; [exact h | exact lm | exact ls | apply v_rational_encloses].
Qed.

Lemma length_is_enclosed i : encloses along (length_form prec v w x S i) (on_line v w middle (7 + i)%nat) (L i).
Proof. exact (line_follows prec v w middle s x S along middle_in_x middle_in_S s_in eq_refl (7 + i)%nat). Qed.

Lemma half_encloses t D d d' l p p' : v_encloses t D d d' -> encloses t l p p' ->
  encloses t (half_form prec D l) (half * (dot d d - p * p)) (half * (dot d' d' - p' * p')).
Proof.
  intros hd hl. unfold half_form. apply mul_encloses; [apply constant_encloses, fraction_is_in |].
  apply sub_encloses; [now apply v_dot_encloses | now apply mul_encloses].
Qed.

Lemma anchors_of_itself i : nth6 (anchors (itself m)) i = (real_vec (base (nth6 (cables m) i)),
  real_vec (platform (nth6 (cables m) i))).
Proof. unfold itself. cbn [anchors]. now rewrite nth6_map. Qed.

Lemma vector_encloses t Q q q' Y y y' Z z z' A a a' c : v_encloses t Q q q' -> v_encloses t Y y y' ->
  v_encloses t Z z z' -> v_encloses t A a a' ->
  v_encloses t (vector_form prec v Q Y Z c A)
    (minus (plus (plus q (times (coordinate v 13) y)) (turn_by (Quaternion (times (coordinate v 14) z) 1) a))
      (real_vec (base c)))
    (minus (plus (plus q' (times (coordinate v 13) y')) (turn_by (Quaternion (times (coordinate v 14) z') 1) a'))
      (real_vec (base c))).
Proof.
  intros hq hy hz ha. apply v_sub_encloses; [| apply v_rational_encloses]. apply v_add_encloses.
  - apply v_add_encloses; [exact hq | now apply shift_encloses].
  - now apply tube_turn_encloses.
Qed.

Lemma start_is_enclosed z i : exists q, encloses along
  (start_form prec v x S chord_box z (nth6 (cables m) i) (arm_range prec x S chord_box (nth6 (cables m) i))
    (length_form prec v w x S i)) q (g (fun k => Q2R (nth6 z k)) i).
Proof.
  destruct chord_is_enclosed as [_ [_ [h _]]].
  unfold g, excess, cable_of. rewrite anchors_of_itself.
  eexists. unfold start_form. apply half_encloses; [| apply length_is_enclosed]. apply tight_enc.
  apply vector_encloses; [exact h | | | apply arm_is_enclosed]; apply v_rational_encloses.
Qed.

(** *** From one place in the tube to another *)

Section Inside.

Variables (z z' : nat -> R).
Hypotheses (z_in : in_box z) (z'_in : in_box z').

Let across : change := Change 0 (fun b => match b with
  0%nat => minus (first3 z') (first3 z) | 1%nat => minus (last3 z') (last3 z) | _ => Vec 0 0 0 end).

Lemma whole_encloses f q q' t : encloses t f q q' -> encloses across (whole prec f) q' q'.
Proof. intros [_ [_ [h _]]]. now apply constant_encloses. Qed.

Lemma v_whole_encloses V u u' t : v_encloses t V u u' -> v_encloses across (v_whole prec V) u' u'.
Proof. intros [a [b c]]. split; [| split]; cbn; eapply whole_encloses; eassumption. Qed.

Lemma any_encloses ball unit c q q' : (ball < balls)%nat -> Rabs q <= 1 -> Rabs q' <= 1 -> v_is_in c unit ->
  q' = q + dot c (of_ball across ball) -> encloses across (any_form prec ball unit) q q'.
Proof.
  intros l a b hc e. assert (one_in := integer_is_in prec 1).
  assert (ends : forall y, Rabs y <= 1 -> is_in y (symmetric (one prec))) by (intros y h;
    now apply (symmetric_is_in 1)).
  split; [now apply ends | split; [now apply ends | split; [now apply ends |]]].
  exists (Change 0 (fun k => if Nat.eqb k ball then c else Vec 0 0 0)). split; [split |].
  - apply (integer_is_in prec 0).
  - now apply b_only_holds.
  - unfold sloped, moved. cbn [of_place of_ball]. rewrite sum_over_one by exact l. rewrite e. cbn [of_place].
    unfold across. cbn [of_place]. ring.
Qed.

Lemma any_vector_encloses ball u u' : (ball < balls)%nat -> in_unit_box u -> in_unit_box u' ->
  of_ball across ball = minus u' u -> v_encloses across (any_vector prec ball) u u'.
Proof.
  intros l [a [b c]] [a' [b' c']] e. assert (o := integer_is_in prec 0). assert (i := integer_is_in prec 1).
  split; [| split]; cbn [any_vector vx vy vz].
  - apply (any_encloses ball _ (Vec 1 0 0)); try assumption; [exact (conj i (conj o o)) |]. rewrite e.
    unfold dot, minus. cbn. ring.
  - apply (any_encloses ball _ (Vec 0 1 0)); try assumption; [exact (conj o (conj i o)) |]. rewrite e.
    unfold dot, minus. cbn. ring.
  - apply (any_encloses ball _ (Vec 0 0 1)); try assumption; [exact (conj o (conj o i)) |]. rewrite e.
    unfold dot, minus. cbn. ring.
Qed.

Lemma parts_in_box y : in_box y -> in_unit_box (first3 y) /\ in_unit_box (last3 y).
Proof.
  intros h. split; (split; [| split]); cbn; apply h; lia.
Qed.

Lemma excess_is_enclosed i : encloses across
  (tube_form prec v chord_box (nth6 (cables m) i) (arm_range prec x S chord_box (nth6 (cables m) i))
    (length_form prec v w x S i)) (g z i) (g z' i).
Proof.
  destruct chord_is_enclosed as [_ [_ [h _]]].
  destruct (parts_in_box z z_in) as [a b]. destruct (parts_in_box z' z'_in) as [a' b'].
  unfold g, excess, cable_of. rewrite anchors_of_itself. unfold tube_form.
  apply half_encloses; [| eapply whole_encloses, length_is_enclosed].
  apply vector_encloses; [eapply v_whole_encloses, h | | | eapply v_whole_encloses, arm_is_enclosed].
  - apply any_vector_encloses; [unfold balls; lia | exact a | exact a' | reflexivity].
  - apply any_vector_encloses; [unfold balls; lia | exact b | exact b' | reflexivity].
Qed.

(** A row of the derivative. *)
Lemma row_is_enclosed i : exists a : nat -> R,
  g z' i - g z i = total (fun j => a j * (z' j - z j)) /\
  forall j, (j < 6)%nat -> is_in (a j) (nth6 (row_of_slopes prec
    (tube_form prec v chord_box (nth6 (cables m) i) (arm_range prec x S chord_box (nth6 (cables m) i))
      (length_form prec v w x S i))) j).
Proof.
  destruct (excess_is_enclosed i) as [_ [_ [_ [k [[_ hk] e]]]]].
  set (f := tube_form _ _ _ _ _ _) in *.
  exists (of_vecs (of_ball k 0) (of_ball k 1)). split.
  - rewrite e. unfold moved, across, balls, SixEquations.total. cbn [of_place of_ball sum_over of_vecs].
    unfold first3, last3, minus, dot. cbn [vx vy vz]. ring.
  - assert (block : forall b, (b < balls)%nat -> v_is_in (of_ball k b)
        (match nth b (slopes f) None with Some u => u | None => Vec (zero prec) (zero prec) (zero prec) end)).
    { intros b l. assert (h := hk b l). destruct (nth b (slopes f) None) as [u |]; [exact h |].
      cbn in h. rewrite h. assert (o := integer_is_in prec 0). exact (conj o (conj o o)). }
    destruct (block 0%nat ltac:(unfold balls; lia)) as [a0 [a1 a2]].
    destruct (block 1%nat ltac:(unfold balls; lia)) as [a3 [a4 a5]].
    apply each_of_six; assumption.
Qed.

End Inside.

(** *** The decision *)

Lemma transposed_entry {A : Type} (M : six (six A)) i j : (i < 6)%nat -> (j < 6)%nat ->
  nth6 (nth6 (transposed M) j) i = nth6 (nth6 M i) j.
Proof.
  intros li lj. revert j lj i li.
  apply (each_of_six (fun j => forall i, (i < 6)%nat -> nth6 (nth6 (transposed M) j) i = nth6 (nth6 M i) j));
    intros i li; exact (nth6_map _ M i).
Qed.

Lemma index_is i : (i < 6)%nat -> nth6 indices i = i.
Proof. revert i. apply each_of_six; reflexivity. Qed.

Lemma one_of_Q : Q2R 1 = 1.
Proof. unfold Q2R. cbn. lra. Qed.

Theorem tube_is_sound b : check_tube prec m v w x S b = true ->
  exists z, in_box z /\ in_box (fun i => Q2R (nth6 (guess b) i)) /\
    (forall i, (i < 6)%nat -> Rabs (z i - Q2R (nth6 (guess b) i)) <= Q2R (within b)) /\
    has_lengths m (map6 (on_line v w s) (Six 7 8 9 10 11 12)%nat) (tube_pose v (chord s) z) /\
    forall z', in_box z' -> has_lengths m (map6 (on_line v w s) (Six 7 8 9 10 11 12)%nat) (tube_pose v (chord s) z') ->
      forall i, (i < 6)%nat -> z' i = z i.
Proof.
  unfold check_tube. cbv zeta. rewrite !andb_true_iff. intros [[[[hL hg] hleft] hrho] heta].
  set (CI := map6 (map6 (number prec (tube_scale b))) (tube_inverse b)) in *.
  set (C := fun i k => Q2R (nth6 (nth6 (tube_inverse b) i) k # Pos.pow 2 (tube_scale b))).
  assert (hC : forall i k, is_in (C i k) (nth6 (nth6 CI i) k)).
  { intros i k. unfold CI. rewrite !nth6_map. apply number_is_in. }
  set (z0 := fun i => Q2R (nth6 (guess b) i)).
  assert (lengths : forall i, (i < 6)%nat -> 0 < L i).
  { intros i li. assert (h := every_is_true _ hL i li).
    rewrite !nth6_map, index_is in h by exact li.
    destruct (length_is_enclosed i) as [_ [_ [e _]]]. eapply above0_is_true; [exact h | exact e]. }
  assert (same_length : forall i, (i < 6)%nat -> nth6 (map6 (on_line v w s) (Six 7 8 9 10 11 12)%nat) i = L i)
    by (apply each_of_six; reflexivity).
  assert (lengths_of : forall P, has_lengths m (map6 (on_line v w s) (Six 7 8 9 10 11 12)%nat) P <->
      forall i, (i < 6)%nat -> excess m L P i = 0).
  { intros P. rewrite has_lengths_each. split; intros h i li.
    - apply excess_is_0; [now apply lengths |]. rewrite (h i li). now apply same_length.
    - assert (e := h i li). apply excess_is_0 in e; [| now apply lengths]. rewrite e. symmetry. now apply same_length. }
  fold chord_box in hrho, heta. set (arms := map6 (arm_range prec x S chord_box) (cables m)) in *.
  set (held_lengths := map6 (length_form prec v w x S) indices) in *.
  set (forms := zip6 _ (zip6 (tube_form prec v chord_box) (cables m) arms) held_lengths) in *.
  set (begins := zip6 _ (zip6 (start_form prec v x S chord_box (guess b)) (cables m) arms) held_lengths) in *.
  set (rows := map6 (row_of_slopes prec) forms) in *.
  set (E := zip6 (fun (c : six interval) (unit : six Z) => zip6 (fun a z =>
    sub prec (integer prec z) (sum prec (zip6 (mul prec) c a)))
    (transposed rows) unit) CI units) in hrho.
  assert (linear : forall z z', in_box z -> in_box z' -> exists A : nat -> nat -> R,
    (forall i, (i < 6)%nat -> g z' i - g z i = apply6 A (fun j => z' j - z j) i) /\
    (forall i, (i < 6)%nat -> total (fun j => Rabs (error6 C A i j)) <= Q2R (left b))).
  { intros z z' hz hz'.
    destruct (six_choices (fun i (a : nat -> R) => g z' i - g z i = total (fun j => a j * (z' j - z j)) /\
      forall j, (j < 6)%nat -> is_in (a j) (nth6 (nth6 rows i) j))) as [A hA].
    { intros i li. destruct (row_is_enclosed z z' hz hz' i) as [a [ea ia]]. exists a. split; [exact ea |].
      unfold rows, forms, held_lengths, arms. rewrite nth6_map, !nth6_zip, !nth6_map, index_is by exact li. exact ia. }
    exists A. split; [intros i li; apply hA; exact li |]. intros k lk.
    assert (hE : forall i, (i < 6)%nat -> forall j, (j < 6)%nat -> is_in (error6 C A i j) (nth6 (nth6 E i) j)).
    { intros i li j lj. unfold E. rewrite !nth6_zip. unfold SixEquations.error6.
      rewrite <- (units_are_delta i j) by assumption.
      apply sub_is_in; [apply integer_is_in |]. apply sum_is_in. intros l ll. rewrite nth6_zip.
      apply mul_is_in; [apply hC |]. rewrite transposed_entry by assumption. now apply hA. }
    assert (in_rho : is_in (most (fun i => total (fun j => Rabs (error6 C A i j))))
        (fold6 I.join (map6 (fun row => sum prec (map6 I.abs row)) E))).
    { apply most_is_in. intros i li. rewrite nth6_map. apply sum_is_in. intros j lj. rewrite nth6_map.
      now apply abs_is_in, hE. }
    assert (r := below_is_true _ _ _ _ _ hrho in_rho (fraction_is_in prec (left b))).
    apply Rle_trans with (2 := Rlt_le _ _ r). exact (most_bounds (fun i => total (fun j =>
      Rabs (error6 C A i j))) k lk). }
  assert (starts : forall i, (i < 6)%nat -> Rabs (total (fun k =>
    C i k * g z0 k)) <= Q2R (within b) * (1 - Q2R (left b))).
  { assert (in_eta : is_in (most (fun i => Rabs (total (fun k => C i k * g z0 k))))
      (fold6 I.join (map6 (fun c => I.abs (range prec (tube_reach prec x S) (f_sum prec
        (zip6 (fun a f => f_mul prec (constant prec a) f) c begins)))) CI))).
    { apply most_is_in. intros i li. rewrite nth6_map. apply abs_is_in.
      destruct (six_choices (fun k q => encloses along (nth6 begins k) q (g z0 k))) as [q hq].
      { intros k lk. unfold begins, held_lengths, arms. rewrite !nth6_zip, !nth6_map, index_is by exact lk.
        apply start_is_enclosed. }
      apply (range_is_in prec along (tube_reach prec x S) along_has_0 along_is_in eq_refl along_is_within _
        (total (fun k => C i k * q k))).
      apply (f_sum_encloses prec along (tube_reach prec x S) eq_refl). intros k lk. rewrite nth6_zip.
      apply mul_encloses; [apply constant_encloses, hC | now apply hq]. }
    assert (e := below_is_true _ _ _ _ _ heta in_eta (fraction_is_in prec _)).
    rewrite Q2R_mult, Q2R_minus, one_of_Q in e. intros i li. apply Rle_trans with (2 := Rlt_le _ _ e).
    exact (most_bounds (fun i => Rabs (total (fun k => C i k * g z0 k))) i li). }
  assert (small : Q2R (left b) < 1) by (apply above_zero_of in hleft; rewrite Q2R_minus, one_of_Q in hleft; lra).
  assert (near : forall i, (i < 6)%nat -> Rabs (z0 i) + Q2R (within b) <= 1).
  { intros i li. assert (h := every_is_true _ hg i li). rewrite nth6_map, andb_true_iff in h. destruct h as [a e].
    apply Qle_bool_iff, Qle_Rle in a. apply Qle_bool_iff, Qle_Rle in e. rewrite Q2R_plus, one_of_Q in a.
    rewrite Q2R_minus, one_of_Q in e. unfold z0, Rabs. destruct (Rcase_abs _); lra. }
  destruct (one_solution g C z0 (Q2R (left b)) (Q2R (within b)) small near starts linear) as [z [close [solved only]]].
  assert (some : 0 <= Q2R (within b)) by (apply Rle_trans with (2 := close 0%nat ltac:(lia)); apply Rabs_pos).
  exists z. split; [| split; [| split; [exact close | split]]].
  - intros i li. assert (a := close i li). assert (e := near i li). assert (t := Rabs_triang (z i - z0 i) (z0 i)).
    replace (z i - z0 i + z0 i) with (z i) in t by ring. lra.
  - intros i li. assert (e := near i li). change (Rabs (z0 i) <= 1). lra.
  - apply lengths_of. intros i li. exact (solved i li).
  - intros z' hz' h. apply only; [exact hz' |]. intros i li. exact (proj1 (lengths_of _) h i li).
Qed.

End Tube.
(** ** A box *)

Lemma exact_is_tracked m P P' : is_exact m = true -> is_tracked m P P' -> P' = P.
Proof.
  unfold is_exact. rewrite !andb_true_iff. intros [[_ position_is_0] turn_is_0] [off [n [angle [ho [_ [ha ->]]]]]].
  apply zero_of in position_is_0. rewrite position_is_0 in ho. rewrite (norm_is_zero off ho).
  assert (zero := no_angle _ _ turn_is_0 ha).
  rewrite zero. destruct P as [[x y z] f]. cbn [position turn]. f_equal.
  - unfold plus. cbn. f_equal; ring.
  - apply functional_extensionality. intros u. apply turn_about_by_nothing.
Qed.

(** A platform in the tube is one of a machine that may be off by how far its coordinates are from others. *)
Lemma guess_is_near m v q P z y : has_tube v = true -> in_box z -> in_box y ->
  (forall i, (i < 6)%nat -> Rabs (z i - y i) <= Q2R q) ->
  is_tracked (near_guess m v q) (tube_pose v P y) (tube_pose v P z).
Proof.
  unfold has_tube. rewrite !andb_true_iff. intros [[[rational p] r] little] hz hy h.
  apply above_zero_of in p. apply above_zero_of in r.
  apply Qle_bool_iff, Qle_Rle in little. replace (Q2R (1 # 8)) with (1 / 8) in little by (unfold Q2R; cbn; lra).
  assert (e13 := without_half_turns v 13 rational). assert (e14 := without_half_turns v 14 rational).
  assert (small : forall x, in_box x -> norm (times (coordinate v 14) (last3 x)) <= 7 / 32).
  { intros x hx. assert (n : norm (last3 x) <= 7 / 4 * 1) by (apply norm_is_small; cbn; apply hx; lia).
    rewrite norm_of_times, e14, Rabs_pos_eq by lra. assert (k := norm_is_positive (last3 x)).
    assert (Q2R (coordinate_q v 14) * norm (last3 x) <= 1 / 8 * (7 / 4 * 1)) by (apply Rmult_le_compat; lra). lra. }
  destruct (small_turn_between _ _ (small y hy) (small z hz)) as [n [angle [hn [ha eq]]]].
  assert (s1 : norm (minus (first3 z) (first3 y)) <= 7 / 4 * Q2R q) by (apply norm_is_small; cbn; apply h; lia).
  assert (s2 : norm (minus (last3 z) (last3 y)) <= 7 / 4 * Q2R q) by (apply norm_is_small; cbn; apply h; lia).
  exists (times (coordinate v 13) (minus (first3 z) (first3 y))), n, angle. split; [| split; [exact hn | split]].
  - cbn [tolerance near_guess of_position]. rewrite norm_of_times, e13, Rabs_pos_eq by lra. rewrite !Q2R_mult.
    replace (Q2R (7 # 4)) with (7 / 4) by (unfold Q2R; cbn; lra).
    replace (Q2R q * Q2R (coordinate_q v 13) * (7 / 4)) with (Q2R (coordinate_q v 13) * (7 / 4 * Q2R q)) by ring.
    apply Rmult_le_compat_l; lra.
  - cbn [tolerance near_guess of_orientation value]. apply Rle_trans with (1 := ha).
    apply Rle_trans with (2 := Rle_abs _).
    replace (minus (times (coordinate v 14) (last3 z)) (times (coordinate v 14) (last3 y))) with
      (times (coordinate v 14) (minus (last3 z) (last3 y))) by (unfold times, minus; cbn; f_equal; ring).
    rewrite norm_of_times, e14, Rabs_pos_eq by lra. rewrite !Q2R_mult.
    replace (Q2R (21 # 4)) with (3 * (7 / 4)) by (unfold Q2R; cbn; lra).
    replace (Q2R q * Q2R (coordinate_q v 14) * (3 * (7 / 4))) with
      (3 * (Q2R (coordinate_q v 14) * (7 / 4 * Q2R q))) by ring.
    apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; lra.
  - unfold tube_pose. cbn [position turn]. f_equal; [| apply functional_extensionality; intros u; apply eq].
    destruct (position P) as [x1 x2 x3]. unfold plus, times, minus. cbn. f_equal; ring.
Qed.

Lemma guess_follows v w y : no_half_turns v = true ->
  follows (guess_form prec v w y) (fun s => tube_pose v (on_chord v w s) (fun i => Q2R (nth6 y i))).
Proof.
  intros rational middle s x S t hm hm' hs ht turns.
  destruct (chord_follows prec v w middle s x S t hm hm' hs ht turns) as [rm [rs [hp [hx [hy hz]]]]].
  assert (sq : forall a, square (Quaternion a 1) <> 0).
  { intros a. assert (h := square_is_positive (Quaternion a 1)). cbn [scalar_part] in h. lra. }
  assert (rigid : forall P, is_rigid P -> is_rigid (tube_pose v P (fun i => Q2R (nth6 y i)))).
  { intros P [l d]. split; unfold tube_pose; cbn [turn].
    - intros u. rewrite (l u) at 1. apply turn_by_is_linear.
    - intros a b. rewrite turn_by_keeps_dot by apply sq. apply d. }
  split; [now apply rigid | split; [now apply rigid |]].
  split; cbn [guess_form position turn place images].
  - apply v_add_encloses; [exact hp | apply shift_encloses; [exact rational | apply v_rational_encloses]].
  - split; [| split]; cbn [vx vy vz];
      (apply tube_turn_encloses; [exact rational | apply v_rational_encloses | assumption]).
Qed.

Theorem held_box_is_sound c v w start b : check_box prec c (Held v w) start b = true ->
  forall s, Q2R start <= s <= Q2R (upto b) -> exists P, held (subject c) v w s P /\
    (forall P', held (subject c) v w s P' -> P' = P) /\
    forall B P', is_built (subject c) B -> is_tracked (subject c) P P' ->
    feasible_at (subject c) B (tension_margin c) (length_margin c) P'.
Proof.
  unfold check_box. rewrite andb_true_iff. intros [_ h] s hs. destruct (tube b) as [k |]; [| discriminate h].
  cbv zeta in h. rewrite !andb_true_iff in h. destruct h as [[[[[exact_m tubed] _] little] tube] poses].
  assert (rational : no_half_turns v = true) by (unfold has_tube in tubed; rewrite !andb_true_iff in tubed; tauto).
  assert (turns : is_turn (chord_form prec v w (middle_of prec start b) (range_of prec start b)) = true)
    by exact (check_pose_turns _ _ _ _ _ _ _ poses).
  destruct (places_are_in prec start b s hs) as [middle [hm [hm' hS]]].
  destruct (tube_is_sound (subject c) v w _ _ middle s hm hm' hS rational turns k tube)
    as [z [boxed [guessed [close [lengths only]]]]].
  exists (tube_pose v (on_chord v w s) z). split; [| split].
  - split; [| exact lengths]. destruct (parts_in_box z boxed) as [a a']. exists (first3 z), (last3 z).
    split; [exact a | split; [exact a' | reflexivity]].
  - intros P' [[y [y' [hy [hy' e]]]] l]. rewrite <- tube_pose_of_vecs in e. subst P'.
    apply same_coordinates. apply only; [now apply in_box_of_vecs | exact l].
  - intros B P' hB tracked. rewrite (exact_is_tracked _ _ _ exact_m tracked).
    change (feasible_at (near_guess (subject c) v (within k)) B (tension_margin c) (length_margin c)
      (tube_pose v (on_chord v w s) z)).
    apply (poses_are_sound prec c _ _ _ little (guess_follows v w (guess k) rational) start b poses s hs); [exact hB |].
    now apply guess_is_near.
Qed.

End Precision.
End Tubes.
