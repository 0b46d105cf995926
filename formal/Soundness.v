(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker accepts is true *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Checker Enclosure Machine.
Import ListNotations.
Open Scope R_scope.

(** ** Six of something *)

Lemma nth6_map {A B : Type} (f : A -> B) l i : nth6 (map6 f l) i = f (nth6 l i).
Proof. do 5 (destruct i as [| i]; [reflexivity |]). reflexivity. Qed.

Lemma nth6_zip {A B C : Type} (f : A -> B -> C) a b i : nth6 (zip6 f a b) i = f (nth6 a i) (nth6 b i).
Proof. do 5 (destruct i as [| i]; [reflexivity |]). reflexivity. Qed.

(** The largest of six numbers, taken in the order of [fold6]. *)
Definition most (r : nat -> R) : R :=
  Rmax (Rmax (Rmax (Rmax (Rmax (r 0%nat) (r 1%nat)) (r 2%nat)) (r 3%nat)) (r 4%nat)) (r 5%nat).

Lemma most_bounds r i : (i < 6)%nat -> r i <= most r.
Proof.
  unfold most. revert i. apply each_of_six;
    repeat first [apply Rle_refl | apply Rmax_r | eapply Rle_trans; [| apply Rmax_l]].
Qed.

Module Soundness (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module N := Enclosure.Enclosure F.
Import N N.C.

Section Precision.

Variable prec : F.precision.

Lemma every_is_true l : every l = true -> forall i, (i < 6)%nat -> nth6 l i = true.
Proof.
  unfold every, fold6. rewrite !andb_true_iff. intros h. decompose [and] h. apply each_of_six; assumption.
Qed.

Lemma join_left x i j : is_in x i -> is_in x (I.join i j).
Proof. intros h. apply I.join_correct. now left. Qed.

Lemma join_right x i j : is_in x j -> is_in x (I.join i j).
Proof. intros h. apply I.join_correct. now right. Qed.

Lemma most_is_in r l : (forall i, (i < 6)%nat -> is_in (r i) (nth6 l i)) -> is_in (most r) (fold6 I.join l).
Proof.
  intros h. unfold most, fold6.
  assert (two : forall x y i j, is_in x i -> is_in y j -> is_in (Rmax x y) (I.join i j)).
  { intros x y i j a b. unfold Rmax. destruct (Rle_dec x y); [now apply join_right | now apply join_left]. }
  repeat apply two; first [apply (h 0%nat); lia | apply (h 1%nat); lia | apply (h 2%nat); lia | apply (h 3%nat); lia |
    apply (h 4%nat); lia | apply (h 5%nat); lia].
Qed.

Lemma sum_is_in r l : (forall i, (i < 6)%nat -> is_in (r i) (nth6 l i)) -> is_in (total r) (sum prec l).
Proof.
  intros h. unfold SixEquations.total, sum, fold6.
  repeat apply add_is_in; first [apply (h 0%nat); lia | apply (h 1%nat); lia | apply (h 2%nat); lia |
    apply (h 3%nat); lia | apply (h 4%nat); lia | apply (h 5%nat); lia].
Qed.

Lemma abs_is_in x i : is_in x i -> is_in (Rabs x) (I.abs i).
Proof. exact (I.abs_correct i (Xreal x)). Qed.

Lemma sqr_is_in x i : is_in x i -> is_in (x * x) (I.sqr prec i).
Proof. intros h. exact (I.sqr_correct prec i (Xreal x) h). Qed.

Lemma symmetric_is_in b y i : is_in b i -> Rabs y <= b -> is_in y (symmetric i).
Proof.
  intros h a. unfold symmetric.
  apply (between_is_in (- b) b); [now apply join_left, neg_is_in | now apply join_right |].
  assert (n : 0 <= b) by (apply Rle_trans with (Rabs y); [apply Rabs_pos | exact a]).
  rewrite Rmin_left, Rmax_right by lra. unfold Rabs in a. destruct (Rcase_abs y); lra.
Qed.

Lemma below_is_true i j x y : below prec i j = true -> is_in x i -> is_in y j -> x < y.
Proof.
  unfold below. intros h a b. assert (0 < y - x) by (eapply above0_is_true; [exact h | now apply sub_is_in]). lra.
Qed.

Lemma strictly_is_inside limits margin x i : strictly prec limits margin i = true -> is_in x i -> inside limits margin x.
Proof.
  unfold strictly, inside. rewrite andb_true_iff. intros [a b] h. split.
  - rewrite <- Q2R_plus. eapply below_is_true; [exact a | apply fraction_is_in | exact h].
  - rewrite <- Q2R_minus. eapply below_is_true; [exact b | exact h | apply fraction_is_in].
Qed.

(** ** The decision *)

Lemma refine_is_in W E Y (w y : nat -> R) (e : nat -> nat -> R) :
  (forall i, (i < 6)%nat -> is_in (w i) (nth6 W i)) ->
  (forall i, (i < 6)%nat -> forall j, (j < 6)%nat -> is_in (e i j) (nth6 (nth6 E i) j)) ->
  (forall i, (i < 6)%nat -> y i = w i + total (fun j => e i j * y j)) ->
  (forall i, (i < 6)%nat -> is_in (y i) (nth6 Y i)) ->
  forall i, (i < 6)%nat -> is_in (y i) (nth6 (refine prec W E Y) i).
Proof.
  intros hw he eq hy i l. unfold refine. rewrite nth6_zip, eq by exact l. apply add_is_in; [now apply hw |].
  apply sum_is_in. intros j lj. rewrite nth6_zip. apply mul_is_in; [now apply he | now apply hy].
Qed.

Theorem decide_is_sound m tension_margin length_margin lengths x0 E W :
  decide prec m tension_margin length_margin lengths x0 E W = true ->
  forall (L x : nat -> R) (e : nat -> nat -> R),
  (forall i, (i < 6)%nat -> is_in (L i) (nth6 lengths i)) ->
  (forall i, (i < 6)%nat -> is_in (x i) (nth6 x0 i)) ->
  (forall i, (i < 6)%nat -> forall j, (j < 6)%nat -> is_in (e i j) (nth6 (nth6 E i) j)) ->
  let rho := most (fun i => total (fun j => Rabs (e i j))) in
  rho < 1 /\
  (forall i, (i < 6)%nat -> 0 < L i) /\
  (forall i, (i < 6)%nat -> inside (length (nth6 (cables m) i)) length_margin (L i)) /\
  forall w, (forall i, (i < 6)%nat -> is_in (w i) (nth6 W i)) -> exists M,
    (forall i, (i < 6)%nat -> Rabs (w i) <= M) /\
    forall y, (forall i, (i < 6)%nat -> Rabs (y i) * (1 - rho) <= M) ->
    (forall i, (i < 6)%nat -> y i = w i + total (fun j => e i j * y j)) ->
    forall i, (i < 6)%nat -> inside (tension (nth6 (cables m) i)) tension_margin (L i * (x i + y i)).
Proof.
  unfold decide. cbv zeta. rewrite !andb_true_iff. intros [[small tensions] hl] L x e inL inx inE.
  set (rho := most (fun i => total (fun j => Rabs (e i j)))).
  assert (in_rho : is_in rho (fold6 I.join (map6 (fun row => sum prec (map6 I.abs row)) E))).
  { apply most_is_in. intros i l. rewrite nth6_map. apply sum_is_in. intros j lj. rewrite nth6_map.
    now apply abs_is_in, inE. }
  assert (r : rho < 1) by (eapply below_is_true; [exact small | exact in_rho | apply (integer_is_in prec 1)]).
  split; [exact r |]. split; [| split].
  - intros i l. assert (h := every_is_true _ hl i l). rewrite nth6_zip, andb_true_iff in h. destruct h as [_ h].
    eapply above0_is_true; [exact h | now apply inL].
  - intros i l. assert (h := every_is_true _ hl i l). rewrite nth6_zip, andb_true_iff in h. destruct h as [h _].
    eapply strictly_is_inside; [exact h | now apply inL].
  - intros w inW. exists (most (fun i => Rabs (w i))). split; [exact (most_bounds (fun i => Rabs (w i))) |].
    intros y near eq i l.
    assert (h := every_is_true _ tensions i l). rewrite nth6_zip in h.
    eapply strictly_is_inside; [exact h |]. rewrite !nth6_zip.
    apply mul_is_in; [now apply inL |]. apply add_is_in; [now apply inx |].
    apply refine_is_in with (w := w) (e := e); try assumption.
    apply refine_is_in with (w := w) (e := e); try assumption.
    assert (first : forall j, (j < 6)%nat -> is_in (y j) (symmetric (div prec (fold6 I.join (map6 I.abs W))
      (sub prec (one prec) (fold6 I.join (map6 (fun row => sum prec (map6 I.abs row)) E)))))).
    { intros j lj. apply (symmetric_is_in (most (fun i => Rabs (w i)) / (1 - rho))).
      - apply div_is_in.
        + apply most_is_in. intros k lk. rewrite nth6_map. now apply abs_is_in, inW.
        + apply sub_is_in; [apply (integer_is_in prec 1) | exact in_rho].
      - apply Rmult_le_reg_r with (1 - rho); [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
        now apply near. }
    intros j lj. revert j lj. apply each_of_six; apply first; lia.
Qed.

(** ** The load *)

Lemma zero_of q : Qeq_bool q 0 = true -> Q2R q = 0.
Proof. intros h. apply Qeq_bool_eq in h. apply Qeq_eqR in h. rewrite h. unfold Q2R. cbn. lra. Qed.

Lemma above_zero_of q : Z.ltb 0 (Qnum q) = true -> 0 < Q2R q.
Proof.
  intros h. apply Z.ltb_lt in h. unfold Q2R. apply Rmult_lt_0_compat; [now apply IZR_lt |].
  apply Rinv_0_lt_compat. now apply IZR_lt.
Qed.

(** c.w, coordinate by coordinate. *)
Definition along_six (c : nat -> R) (w : six R) : R := total (fun k => c k * nth6 w k).

Lemma item_is_in c cI center shape w : (forall k, (k < 6)%nat -> is_in (c k) (nth6 cI k)) ->
  is_diagonal shape = true -> in_item (Ellipsoid center shape) w ->
  is_in (along_six c (six_of w)) (item_range prec cI (Ellipsoid center shape)).
Proof.
  intros hc diag h.
  set (z := fun k => nth6 (six_of w) k - Q2R (nth6 center k)).
  set (e := fun k => Q2R (nth6 (diagonal shape) k)).
  set (l := [(c 0%nat, e 0%nat, z 0%nat); (c 1%nat, e 1%nat, z 1%nat); (c 2%nat, e 2%nat, z 2%nat);
             (c 3%nat, e 3%nat, z 3%nat); (c 4%nat, e 4%nat, z 4%nat); (c 5%nat, e 5%nat, z 5%nat)]).
  assert (hl : positive l /\ Lemmas.form l <= 1).
  { unfold is_diagonal, every, zip6, units, fold6 in diag. cbn [at1 at2 at3 at4 at5 at6 Z.eqb] in diag.
    rewrite !andb_true_iff in diag. decompose [and] diag. clear diag.
    repeat match goal with H : Qeq_bool _ 0 = true |- _ => apply zero_of in H
      | H : Z.ltb 0 _ = true |- _ => apply above_zero_of in H end.
    split.
    - unfold l, positive, e, diagonal. repeat constructor; cbn [fst snd nth6 at1 at2 at3 at4 at5 at6]; assumption.
    - cbn [in_item] in h. unfold sum6, zip6, fold6 in h. cbn [at1 at2 at3 at4 at5 at6] in h.
      repeat match goal with H : Q2R _ = 0 |- _ => rewrite H in h; clear H end.
      unfold l, Lemmas.form, Lemmas.total, e, z, diagonal. cbn [fold_right nth6 at1 at2 at3 at4 at5 at6].
      eapply Rle_trans; [| exact h]. apply Req_le. ring. }
  destruct hl as [hp hf]. assert (a := range_of_ellipsoid l hp hf).
  replace (along_six c (six_of w)) with (along_six c (map6 Q2R center) + linear l).
  - unfold item_range. apply add_is_in.
    + apply sum_is_in. intros k lk. rewrite nth6_zip, nth6_map. apply mul_is_in; [now apply hc | apply fraction_is_in].
    + apply (symmetric_is_in (sqrt (spread l))); [| exact a]. apply sqrt_is_in.
      replace (spread l) with (total (fun k => c k * c k / e k)).
      * apply sum_is_in. intros k lk. rewrite nth6_zip. apply div_is_in; [now apply sqr_is_in, hc | apply fraction_is_in].
      * unfold l, spread, Lemmas.total, SixEquations.total. cbn [fold_right]. ring.
  - unfold along_six, l, linear, Lemmas.total, SixEquations.total, z. cbn [fold_right]. rewrite !nth6_map. ring.
Qed.

Lemma load_is_in c cI l : (forall k, (k < 6)%nat -> is_in (c k) (nth6 cI k)) -> in_scope l = true ->
  forall w, in_load l w -> is_in (along_six c (six_of w)) (load_range prec l cI).
Proof.
  intros hc. induction l as [| i l IH]; intros scope w h; cbn [in_load load_range fold_right] in *.
  - rewrite h. unfold load_range. cbn [fold_right].
    replace (along_six c _) with 0; [apply (integer_is_in prec 0) |].
    unfold along_six, SixEquations.total. cbn. ring.
  - destruct h as [a [b [eq [ha hb]]]]. rewrite eq.
    unfold in_scope in scope. cbn [forallb] in scope. rewrite andb_true_iff in scope. destruct scope as [s1 s2].
    replace (along_six c (six_of (wrench_plus a b))) with (along_six c (six_of a) + along_six c (six_of b)).
    + unfold load_range. cbn [fold_right]. apply add_is_in; [| now apply IH].
      destruct i. now apply item_is_in.
    + unfold along_six, SixEquations.total. rewrite six_of_plus, !nth6_zip. ring.
Qed.

(** ** Poses *)

Section Offset.

Variables (t : R) (offset : interval).
Hypotheses (zero_in : is_in 0 offset) (t_in : is_in t offset).

Notation enc := (encloses t).
Notation add_enc := (add_encloses prec t).
Notation sub_enc := (sub_encloses prec t).
Notation mul_enc := (mul_encloses prec t).

Definition v_encloses (V : vec form) (u u' : vec R) : Prop :=
  enc (vx V) (vx u) (vx u') /\ enc (vy V) (vy u) (vy u') /\ enc (vz V) (vz u) (vz u').

Ltac by_parts := repeat first [assumption | apply add_encloses | apply sub_encloses | apply mul_encloses |
  apply tight_encloses; [exact zero_in | exact t_in |]].

Lemma v_add_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_add prec V W) (plus u w) (plus u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_sub_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_sub prec V W) (minus u w) (minus u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_scale_encloses k q q' V u u' : enc k q q' -> v_encloses V u u' ->
  v_encloses (v_scale prec k V) (times q u) (times q' u').
Proof. intros h [a [b c]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_tight_encloses V u u' : v_encloses V u u' -> v_encloses (v_tight prec offset V) u u'.
Proof. intros [a [b c]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_cross_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_cross prec V W) (cross u w) (cross u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_rational_encloses u : v_encloses (v_rational prec u) (real_vec u) (real_vec u).
Proof. split; [| split]; cbn; apply constant_encloses, fraction_is_in. Qed.

Lemma rot_x_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_x prec (f_cos prec F) (f_sin prec F) V) (rot_x q u) (rot_x q' u').
Proof.
  intros h [a [b c]]. assert (hc := cos_encloses prec t _ _ _ h). assert (hs := sin_encloses prec t _ _ _ h).
  split; [| split]; cbn; by_parts.
Qed.

Lemma rot_y_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_y prec (f_cos prec F) (f_sin prec F) V) (rot_y q u) (rot_y q' u').
Proof.
  intros h [a [b c]]. assert (hc := cos_encloses prec t _ _ _ h). assert (hs := sin_encloses prec t _ _ _ h).
  split; [| split]; cbn; by_parts.
Qed.

Lemma rot_z_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_z prec (f_cos prec F) (f_sin prec F) V) (rot_z q u) (rot_z q' u').
Proof.
  intros h [a [b c]]. assert (hc := cos_encloses prec t _ _ _ h). assert (hs := sin_encloses prec t _ _ _ h).
  split; [| split]; cbn; by_parts.
Qed.

(** What [pose_at] turns by. *)
Definition turn_of (a : angles) (v : expr -> R) (u : vec R) : vec R :=
  match a with
  | TiltTorsion phi theta sigma => rot_z (v phi) (rot_y (v theta) (rot_z (v sigma - v phi) u))
  | RollPitchYaw roll pitch yaw => rot_z (v yaw) (rot_y (v pitch) (rot_x (v roll) u))
  | Zyz alpha beta gamma => rot_z (v alpha) (rot_y (v beta) (rot_z (v gamma) u))
  end.

Definition axis_x : vec R := Vec 1 0 0.
Definition axis_y : vec R := Vec 0 1 0.
Definition axis_z : vec R := Vec 0 0 1.

Lemma turn_is_linear a v u : turn_of a v u =
  plus (plus (times (vx u) (turn_of a v axis_x)) (times (vy u) (turn_of a v axis_y))) (times (vz u) (turn_of a v axis_z)).
Proof.
  destruct u as [x y z], a; cbn [turn_of];
    unfold rot_z, rot_y, rot_x, plus, times, axis_x, axis_y, axis_z; cbn [vx vy vz]; f_equal; ring.
Qed.

Variables (p : nat -> form) (v v' : nat -> R).
Hypothesis p_encloses : forall i, enc (p i) (v i) (v' i).

Let value_encloses e : enc (eval prec p e) (value v e) (value v' e) := eval_encloses prec t p v v' p_encloses e.

Lemma one_encloses : enc (constant prec (one prec)) 1 1.
Proof. apply constant_encloses, (integer_is_in prec 1). Qed.

Lemma zero_encloses : enc (constant prec (zero prec)) 0 0.
Proof. apply constant_encloses, (integer_is_in prec 0). Qed.

Lemma rotation_encloses a :
  v_encloses (vx (rotation prec a p)) (turn_of a (value v) axis_x) (turn_of a (value v') axis_x) /\
  v_encloses (vy (rotation prec a p)) (turn_of a (value v) axis_y) (turn_of a (value v') axis_y) /\
  v_encloses (vz (rotation prec a p)) (turn_of a (value v) axis_z) (turn_of a (value v') axis_z).
Proof.
  assert (one_enc := one_encloses). assert (zero_enc := zero_encloses).
  destruct a; cbn [rotation turn_of vx vy vz]; (split; [| split]);
    repeat first [apply value_encloses | apply sub_encloses | apply rot_z_encloses | apply rot_y_encloses |
      apply rot_x_encloses | (split; [| split]; assumption)].
Qed.

Lemma turned_encloses a U u u' : v_encloses U u u' ->
  v_encloses (turned prec (rotation prec a p) U) (turn_of a (value v) u) (turn_of a (value v') u').
Proof.
  intros h. assert (h' := h). destruct h' as [hx [hy hz]]. destruct (rotation_encloses a) as [x [y z]].
  rewrite (turn_is_linear a (value v) u), (turn_is_linear a (value v') u'). unfold turned.
  repeat first [apply v_add_encloses | apply v_scale_encloses; assumption].
Qed.

Variable m : machine.
Let at_m := pose_at m v.
Let at_s := pose_at m v'.
Let rotation_form := rotation prec (pose_angles m) p.
Let position_form :=
  Vec (eval prec p (vx (pose_position m))) (eval prec p (vy (pose_position m))) (eval prec p (vz (pose_position m))).

Lemma position_encloses : v_encloses position_form (position at_m) (position at_s).
Proof. split; [| split]; apply value_encloses. Qed.

Lemma column_encloses c k : (k < 6)%nat ->
  enc (nth6 (column_form prec offset rotation_form position_form m c) k)
      (nth6 (density_column m at_m c) k) (nth6 (density_column m at_s c) k).
Proof.
  assert (d : v_encloses (v_tight prec offset (v_sub prec (v_add prec position_form
      (turned prec rotation_form (v_rational prec (platform c)))) (v_rational prec (base c))))
    (cable_vector at_m c) (cable_vector at_s c)).
  { apply v_tight_encloses. unfold cable_vector. apply v_sub_encloses; [| apply v_rational_encloses].
    apply v_add_encloses; [apply position_encloses |].
    exact (turned_encloses (pose_angles m) _ _ _ (v_rational_encloses (platform c))). }
  assert (r : v_encloses (v_tight prec offset (turned prec rotation_form
      (v_rational_difference prec (platform c) (load_point m)))) (lever m at_m c) (lever m at_s c)).
  { apply v_tight_encloses. unfold lever.
    apply (turned_encloses (pose_angles m)). apply v_sub_encloses; apply v_rational_encloses. }
  assert (x := v_cross_encloses _ _ _ _ _ _ r d).
  destruct d as [dx [dy dz]], x as [xx [xy xz]].
  revert k. apply each_of_six; cbn [nth6 column_form density_column at1 at2 at3 at4 at5 at6]; assumption.
Qed.

(** ** A pose *)

Lemma f_sum_encloses l r r' : (forall k, (k < 6)%nat -> enc (nth6 l k) (r k) (r' k)) ->
  enc (f_sum prec l) (total r) (total r').
Proof.
  intros h. unfold SixEquations.total, f_sum, fold6.
  repeat apply add_encloses; first [apply (h 0%nat); lia | apply (h 1%nat); lia | apply (h 2%nat); lia |
    apply (h 3%nat); lia | apply (h 4%nat); lia | apply (h 5%nat); lia].
Qed.

Lemma number_is_in scale z : is_in (Q2R (z # Pos.pow 2 scale)) (number prec scale z).
Proof. apply fraction_is_in. Qed.

Lemma units_are_delta i j : (i < 6)%nat -> (j < 6)%nat -> IZR (nth6 (nth6 units i) j) = SixEquations.delta i j.
Proof.
  intros a b. revert j b. revert i a.
  apply (each_of_six (fun i => forall j, (j < 6)%nat -> IZR (nth6 (nth6 units i) j) = SixEquations.delta i j));
    apply each_of_six; reflexivity.
Qed.

(* So that Coq's kernel compares what these are applied to, before it looks into them. *)
Strategy 1000 [decide product error_ranges rest_ranges rotation eval column_form length_range].
Strategy 1000 [densities_matrix density_column pose_at SixEquations.total SixEquations.error6 along_six rest].
Strategy expand [check_pose].

Theorem pose_is_sound tension_margin length_margin b : in_scope (load m) = true ->
  check_pose prec offset m tension_margin length_margin b p = true ->
  feasible_at m tension_margin length_margin at_s.
Proof.
  intros scope h. unfold check_pose in h. cbv zeta in h.
  fold rotation_form position_form in h.
  set (columns := map6 (column_form prec offset rotation_form position_form m) (cables m)) in h.
  set (CI := map6 (map6 (number prec (scale b))) (inverse b)) in h.
  set (xI := map6 (number prec (scale b)) (densities b)) in h.
  set (C := fun i k => Q2R (nth6 (nth6 (inverse b) i) k # Pos.pow 2 (scale b))).
  set (x0 := fun i => Q2R (nth6 (densities b) i # Pos.pow 2 (scale b))).
  set (A := densities_matrix m at_s). set (A' := densities_matrix m at_m).
  assert (hC : forall i k, is_in (C i k) (nth6 (nth6 CI i) k)).
  { intros i k. unfold CI. rewrite !nth6_map. apply number_is_in. }
  assert (hx : forall i, is_in (x0 i) (nth6 xI i)).
  { intros i. unfold xI. rewrite nth6_map. apply number_is_in. }
  assert (hcol : forall i k, (k < 6)%nat -> enc (nth6 (nth6 columns i) k) (A' k i) (A k i)).
  { intros i k l. unfold columns. rewrite nth6_map. now apply column_encloses. }
  assert (hCD : forall i j, enc (nth6 (nth6 (product prec CI columns) i) j)
      (total (fun k => C i k * A' k j)) (total (fun k => C i k * A k j))).
  { intros i j. unfold product. rewrite !nth6_map. apply f_sum_encloses. intros k l. rewrite nth6_zip.
    apply mul_encloses; [apply constant_encloses, hC | now apply hcol]. }
  assert (hE : forall i, (i < 6)%nat -> forall j, (j < 6)%nat ->
      is_in (error6 C A i j) (nth6 (nth6 (error_ranges prec offset (product prec CI columns)) i) j)).
  { intros i li j lj. unfold error_ranges. rewrite !nth6_zip.
    assert (E : enc (tight prec offset (f_sub prec (constant prec (integer prec (nth6 (nth6 units i) j)))
        (nth6 (nth6 (product prec CI columns) i) j))) (error6 C A' i j) (error6 C A i j)).
    { apply tight_encloses; [exact zero_in | exact t_in |]. unfold SixEquations.error6.
      rewrite <- (units_are_delta i j) by assumption.
      apply sub_encloses; [apply constant_encloses, integer_is_in | apply hCD]. }
    destruct E as [_ [_ [E _]]]. exact E. }
  assert (hL : forall i, (i < 6)%nat -> is_in (length_of m at_s i) (nth6 (map6 (length_range prec) columns) i)).
  { intros i li. rewrite nth6_map. unfold length_range, length_of, cable_length, norm, dot.
    apply sqrt_is_in. repeat apply add_is_in; apply sqr_is_in.
    - destruct (hcol i 0%nat) as [_ [_ [q _]]]; [lia | exact q].
    - destruct (hcol i 1%nat) as [_ [_ [q _]]]; [lia | exact q].
    - destruct (hcol i 2%nat) as [_ [_ [q _]]]; [lia | exact q]. }
  destruct (decide_is_sound m tension_margin length_margin _ _ _ _ h (length_of m at_s) x0 (error6 C A) hL
    (fun i _ => hx i) hE) as [small [positive [lengths loads]]].
  apply (pose_is_feasible m at_s tension_margin length_margin C x0
    (most (fun i => total (fun j => Rabs (error6 C A i j))))); try assumption.
  - apply (most_bounds (fun i => total (fun j => Rabs (error6 C A i j)))).
  - intros w hw. apply loads. intros i li. unfold rest_ranges. rewrite !nth6_zip.
    replace (rest m at_s C x0 w i) with
      (along_six (C i) (six_of w) - total (fun j => total (fun k => C i k * A k j) * x0 j)).
    + apply sub_is_in; [apply load_is_in; [intros k lk; apply hC | exact scope | exact hw] |].
      assert (E : enc (tight prec offset (f_sum prec (zip6 (fun e x => f_mul prec e (constant prec x))
          (nth6 (product prec CI columns) i) xI))) (total (fun j => total (fun k => C i k * A' k j) * x0 j))
          (total (fun j => total (fun k => C i k * A k j) * x0 j))).
      { apply tight_encloses; [exact zero_in | exact t_in |]. apply f_sum_encloses. intros j lj. rewrite nth6_zip.
        apply mul_encloses; [apply hCD | apply constant_encloses, hx]. }
      destruct E as [_ [_ [E _]]]. exact E.
    + exact (rest_splits (C i) (nth6 (six_of w)) x0 A).
Qed.

End Offset.
(** ** A path *)

Lemma point_is_in u i : is_in (coordinate u i)
  (let (q, h) := nth i u (0%Q, 0%Z) in add prec (fraction prec q) (mul prec (integer prec h) (I.pi prec))).
Proof.
  unfold coordinate. destruct (nth i u (0%Q, 0%Z)) as [q h].
  apply add_is_in; [apply fraction_is_in |]. apply mul_is_in; [apply integer_is_in | apply I.pi_correct].
Qed.

Lemma parameter_encloses v w middle s m S : is_in middle m -> is_in middle S -> is_in s S ->
  forall i, encloses (s - middle) (parameter prec v w m S i) (on_segment v w middle i) (on_segment v w s i).
Proof.
  intros hm hm' hs i. unfold on_segment, parameter. cbv zeta.
  assert (a := point_is_in v i). assert (k := sub_is_in prec _ _ _ _ (point_is_in w i) a).
  split; [| split; [| split]]; cbn [mid over slope].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - apply add_is_in; [exact a | now apply mul_is_in].
  - exists (coordinate w i - coordinate v i). split; [exact k | unfold sloped; ring].
Qed.

Section Certificate.

Variable c : certificate.
Hypothesis scope : in_scope (load (subject c)) = true.

Notation holds v w s :=
  (feasible_at (subject c) (tension_margin c) (length_margin c) (pose_at (subject c) (on_segment v w s))).

Theorem box_is_sound v w start b : check_box prec c v w start b = true ->
  forall s, Q2R start <= s <= Q2R (upto b) -> holds v w s.
Proof.
  unfold check_box. cbv zeta. rewrite andb_true_iff. intros [_ h] s [l u].
  set (middle := Qred ((start + upto b) * (1 # 2))) in h.
  set (S := I.join (between prec start (upto b)) (fraction prec middle)) in h.
  assert (hm : is_in (Q2R middle) (fraction prec middle)) by apply fraction_is_in.
  assert (hm' : is_in (Q2R middle) S) by now apply join_right.
  assert (hs : is_in s S).
  { apply join_left. unfold between. apply (between_is_in (Q2R start) (Q2R (upto b))).
    - apply join_left, fraction_is_in.
    - apply join_right, fraction_is_in.
    - rewrite Rmin_left, Rmax_right by lra. lra. }
  refine (pose_is_sound (s - Q2R middle) _ _ _ _ (on_segment v w (Q2R middle)) (on_segment v w s)
    (parameter_encloses v w _ _ _ _ hm hm' hs) (subject c) _ _ b scope h).
  - replace 0 with (Q2R middle - Q2R middle) by ring. now apply sub_is_in.
  - now apply sub_is_in.
Qed.

Lemma boxes_are_sound v w l : forall start, check_boxes prec c v w start l = true ->
  forall s, Q2R start <= s <= 1 -> holds v w s.
Proof.
  induction l as [| b l IH]; intros start h s [x y]; [discriminate h |].
  destruct l as [| b' l].
  - cbn [check_boxes] in h. rewrite andb_true_iff in h. destruct h as [e h].
    apply (box_is_sound v w start b h). split; [exact x |].
    apply Qeq_bool_eq, Qeq_eqR in e. rewrite e. unfold Q2R. cbn. lra.
  - change (check_box prec c v w start b && check_boxes prec c v w (upto b) (b' :: l) = true) in h.
    rewrite andb_true_iff in h. destruct h as [h h'].
    destruct (Rle_dec s (Q2R (upto b))) as [le | gt].
    + apply (box_is_sound v w start b h). lra.
    + apply (IH (upto b) h'). lra.
Qed.

Lemma path_is_sound path : forall l, check_path prec c path l = true ->
  along (fun p => feasible_at (subject c) (tension_margin c) (length_margin c) (pose_at (subject c) p)) path.
Proof.
  induction path as [| v path IH]; intros l h; [exact I |].
  destruct path as [| w path]; [exact I |].
  destruct l as [| b l]; [discriminate h |].
  change (check_boxes prec c v w 0 b && check_path prec c (w :: path) l = true) in h.
  rewrite andb_true_iff in h. destruct h as [h h']. split; [| exact (IH l h')].
  intros s [x y]. apply (boxes_are_sound v w b 0 h). split; [| exact y]. unfold Q2R. cbn. lra.
Qed.

End Certificate.
End Precision.

(** What the checker accepts is true. *)
Theorem check_sound c : check c = true -> statement c.
Proof.
  unfold check. rewrite !andb_true_iff. intros [[many scope] h]. split; [now apply PeanoNat.Nat.leb_le |].
  exact (path_is_sound (F.PtoP (bits c)) c scope (path c) (boxes c) h).
Qed.

End Soundness.
