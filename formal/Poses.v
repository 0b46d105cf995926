(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker accepts at a pose is true *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Loads Turns Checker Enclosure Machine.
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

Module Poses (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module N := Enclosure.Enclosure F.
Import N N.C.

Section Precision.

Variable prec : F.precision.

Lemma every_is_true l : every l = true -> forall i, (i < 6)%nat -> nth6 l i = true.
Proof.
  unfold every, fold6. rewrite !andb_true_iff. intros h. decompose [and] h. apply each_of_six; assumption.
Qed.

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

Lemma below_is_true i j x y : below prec i j = true -> is_in x i -> is_in y j -> x < y.
Proof.
  unfold below. intros h a b. assert (0 < y - x) by (eapply above0_is_true; [exact h | now apply sub_is_in]). lra.
Qed.

Lemma strictly_is_inside limits margin x i : strictly prec limits margin i = true -> is_in x i ->
  inside limits margin x.
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

(** Within no tolerance, no turn. *)
Lemma no_angle e angle : is_zero_number e = true -> Rabs angle <= Rabs (value (fun _ => 0) e) -> angle = 0.
Proof.
  destruct e as [q | | | | | | | | | |]; try discriminate. cbn [is_zero_number value]. intros z h. apply zero_of in z.
  rewrite z, Rabs_R0 in h. assert (p := Rabs_pos angle).
  destruct (Req_dec angle 0) as [y | n]; [exact y |]. apply Rabs_pos_lt in n. lra.
Qed.

Lemma above_zero_of q : Z.ltb 0 (Qnum q) = true -> 0 < Q2R q.
Proof.
  intros h. apply Z.ltb_lt in h. unfold Q2R. apply Rmult_lt_0_compat; [now apply IZR_lt |].
  apply Rinv_0_lt_compat. now apply IZR_lt.
Qed.

(** c.w, coordinate by coordinate. *)
Definition along_six (c : nat -> R) (w : six R) : R := total (fun k => c k * nth6 w k).

Lemma along_is_in c cI w : (forall k, (k < 6)%nat -> is_in (c k) (nth6 cI k)) ->
  is_in (along_six c (map6 Q2R w)) (along prec cI w).
Proof.
  intros hc. apply sum_is_in. intros k lk. rewrite nth6_zip, nth6_map.
  apply mul_is_in; [now apply hc | apply fraction_is_in].
Qed.

Definition real_squares : list (Q * list Q) -> list (R * list R) := map (fun s => (Q2R (fst s), map Q2R (snd s))).

Lemma qred_is q : Q2R (Qred q) = Q2R q.
Proof. apply Qeq_eqR, Qred_correct. Qed.

Lemma agree_is_equal k l : agree k l = true -> map Q2R k = map Q2R l /\ List.length k = List.length l.
Proof.
  revert l. induction k as [| x k IH]; intros [| y l] h; try discriminate h; [split; reflexivity |].
  cbn [agree] in h. apply andb_true_iff in h. destruct h as [e h]. apply Qeq_bool_eq, Qeq_eqR in e.
  destruct (IH l h) as [a b]. cbn [map List.length]. split; congruence.
Qed.

Lemma less_times_is k s r : map Q2R (less_times k s r) = less (map Q2R s) (map (Rmult (Q2R k)) (map Q2R r)).
Proof.
  revert s. induction r as [| x r IH]; intros s; [now destruct s |].
  destruct s as [| y s]; cbn [less_times map less]; rewrite qred_is, ?Q2R_opp, ?Q2R_minus, Q2R_mult, IH; reflexivity.
Qed.

Lemma quad_of_reduced r k rows z w : List.length rows = List.length k ->
  quad (map (map Q2R) (reduced r k rows)) z w = quad (map (map Q2R) rows) z w - lin (map Q2R k) z * lin (map Q2R r) w.
Proof.
  revert rows z. induction k as [| x k IH]; intros [| s rows] z l; try discriminate l; [destruct z; cbn; ring |].
  destruct z as [| z1 z]; cbn [reduced map quad lin]; [ring |]. rewrite IH by (injection l; trivial).
  assert (e : lin (map Q2R (if Qeq_bool x 0 then s else less_times x s r)) w = lin (map Q2R s) w - Q2R x * lin (map Q2R
    r) w).
  { destruct (Qeq_bool x 0) eqn:z0; [apply zero_of in z0; rewrite z0; ring |].
    now rewrite less_times_is, lin_of_less, lin_of_times. }
  rewrite e. ring.
Qed.

Lemma hd_map rows : map (hd 0) (map (map Q2R) rows) = map Q2R (map (hd 0%Q) rows).
Proof.
  rewrite !map_map. apply map_ext. intros [| b s]; cbn; [unfold Q2R; cbn; lra | reflexivity].
Qed.

Lemma tl_map rows : map (@tl R) (map (map Q2R) rows) = map (map Q2R) (map (@tl Q) rows).
Proof. rewrite !map_map. apply map_ext. now intros [| b s]. Qed.

Lemma squares_are_the_form n : forall rows l, squares n rows = Some l ->
  positive (real_squares l) /\ List.length l = n /\
  forall z, quad (map (map Q2R) rows) z z = Lemmas.form (real_squares l) z.
Proof.
  induction n as [| n IH]; intros rows l h.
  - destruct rows; [| discriminate h]. injection h as <-. split; [constructor | split;
    [reflexivity | now intros [| x z]]].
  - destruct rows as [| [| a r] rows]; try discriminate h. cbn [squares] in h.
    destruct (Z.ltb 0 (Qnum a) && agree (map (hd 0%Q) rows) r) eqn:ok; [| discriminate h].
    apply andb_true_iff in ok. destruct ok as [pos same]. apply above_zero_of in pos.
    set (k := map (fun x => Qred (x / a)) r) in h.
    destruct (squares n (reduced r k (map (@tl Q) rows))) as [l' |] eqn:e; [| discriminate h]. injection h as <-.
    destruct (IH _ _ e) as [p [len eq]]. split; [now constructor | split; [cbn; now rewrite len |]].
    destruct (agree_is_equal _ _ same) as [heads many].
    assert (hk : forall z, Q2R a * lin (map Q2R k) z = lin (map Q2R r) z).
    { intros z. unfold k. rewrite map_map. rewrite <- lin_of_times, map_map. f_equal. apply map_ext. intros x.
      rewrite qred_is, Q2R_div; [field; lra |]. intros z0. apply Qeq_eqR in z0. unfold Q2R in z0 at 2. cbn in z0. lra. }
    intros [| x z]; [reflexivity |]. cbn [map quad lin real_squares fst snd].
      rewrite quad_peeled, hd_map, heads, tl_map.
    cbn [Lemmas.form]. change (map _ l') with (real_squares l'). rewrite <- eq.
    rewrite quad_of_reduced by (unfold k; rewrite !map_length in *; exact many).
    rewrite <- (hk z). ring.
Qed.

Lemma less_range_is_in c i y Y k : is_in c i -> Forall2 is_in y Y ->
  Forall2 is_in (less y (map (Rmult c) (map Q2R k))) (less_range prec i Y k).
Proof.
  intros hc. revert y Y. induction k as [| x k IH]; intros y Y h.
  - destruct h; constructor; assumption.
  - destruct h as [| y1 j y Y hy h]; cbn [map less less_range]; constructor; try (apply IH; now try constructor).
    + apply neg_is_in, mul_is_in; [exact hc | apply fraction_is_in].
    + destruct (Qeq_bool x 0) eqn:z; [apply zero_of in z; now rewrite z, Rmult_0_r, Rminus_0_r |].
      apply sub_is_in; [exact hy |]. apply mul_is_in; [exact hc | apply fraction_is_in].
Qed.

Lemma spread_is_in l : forall y Y, Forall2 is_in y Y -> is_in (spread (real_squares l) y) (spread_range prec l Y).
Proof.
  induction l as [| [a k] l IH]; intros y Y h; [apply (integer_is_in prec 0) |].
  destruct h as [| c i y Y hc h]; [apply (integer_is_in prec 0) |]. cbn [real_squares map spread spread_range fst snd].
  apply add_is_in; [apply div_is_in; [now apply sqr_is_in | apply fraction_is_in] |]. apply IH.
    now apply less_range_is_in.
Qed.

Lemma ellipsoid_is_in b P c cI center shift shape w l : (forall k, (k < 6)%nat -> is_in (c k) (nth6 cI k)) ->
  squares 6 (list_of (map6 list_of shape)) = Some l -> in_item b P (Ellipsoid center shift shape) w ->
  is_in (along_six c (six_of w) - along_six c (map6 Q2R center))
    (symmetric (add prec (I.abs (along prec cI shift)) (I.sqrt prec (spread_range prec l (list_of cI))))).
Proof.
  intros hc hl [x [hx h]]. cbv zeta in h.
  set (z := zip6 Rminus (six_of w) (zip6 (fun c d : Q => c + x * d) center shift)) in h.
  destruct (squares_are_the_form _ _ _ hl) as [pos [len eq]].
  set (y := [c 0%nat; c 1%nat; c 2%nat; c 3%nat; c 4%nat; c 5%nat]).
  assert (below : Lemmas.form (real_squares l) (list_of z) <= 1).
  { rewrite <- eq. eapply Rle_trans; [| exact h]. apply Req_le. clear.
    unfold sum6, fold6, zip6, list_of, map6. cbn [at1 at2 at3 at4 at5 at6 map quad lin]. ring. }
  assert (a := range_of_ellipsoid (real_squares l) y (list_of z) pos
    ltac:(unfold real_squares; rewrite map_length, len; apply le_n) below).
  replace (along_six c (six_of w) - along_six c (map6 Q2R center)) with
    (x * along_six c (map6 Q2R shift) + lin y (list_of z)).
  - apply (symmetric_is_in (Rabs (along_six c (map6 Q2R shift)) + sqrt (spread (real_squares l) y))).
    + apply add_is_in; [now apply abs_is_in, along_is_in |]. apply sqrt_is_in, spread_is_in. unfold y, list_of.
      repeat constructor; first [apply (hc 0%nat); lia | apply (hc 1%nat); lia | apply (hc 2%nat); lia |
        apply (hc 3%nat); lia | apply (hc 4%nat); lia | apply (hc 5%nat); lia].
    + apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [| exact a].
      rewrite Rabs_mult. rewrite <- (Rmult_1_l (Rabs (along_six c (map6 Q2R shift)))) at 2.
      apply Rmult_le_compat_r; [apply Rabs_pos |]. now apply Rabs_le.
  - unfold along_six, y, list_of, z, SixEquations.total, zip6, map6. cbn [nth6 at1 at2 at3 at4 at5 at6 lin]. ring.
Qed.

(** ** Poses *)

Section Offset.

Variables (t : change) (reach : interval * list interval).
Hypotheses (zero_in : is_in 0 (fst reach)) (t_in : is_in (of_place t) (fst reach))
  (as_many : List.length (snd reach) = balls) (t_within : deviates_within (of_ball t) balls (snd reach)).

Notation enc := (encloses t).
Notation add_enc := (add_encloses prec t).
Notation sub_enc := (sub_encloses prec t).
Notation mul_enc := (mul_encloses prec t).

Definition v_encloses (V : vec form) (u u' : vec R) : Prop :=
  enc (vx V) (vx u) (vx u') /\ enc (vy V) (vy u) (vy u') /\ enc (vz V) (vz u) (vz u').

Ltac by_parts := repeat first [assumption | apply add_encloses | apply sub_encloses | apply mul_encloses |
  apply tight_encloses; [exact zero_in | exact t_in | exact as_many | exact t_within |]].

Lemma v_add_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_add prec V W) (plus u w) (plus u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_sub_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_sub prec V W) (minus u w) (minus u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_scale_encloses k q q' V u u' : enc k q q' -> v_encloses V u u' ->
  v_encloses (v_scale prec k V) (times q u) (times q' u').
Proof. intros h [a [b c]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_tight_encloses V u u' : v_encloses V u u' -> v_encloses (v_tight prec reach V) u u'.
Proof. intros [a [b c]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_cross_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  v_encloses (v_cross prec V W) (cross u w) (cross u' w').
Proof. intros [a [b c]] [d [e f]]. split; [| split]; cbn; by_parts. Qed.

Lemma v_rational_encloses u : v_encloses (v_rational prec u) (real_vec u) (real_vec u).
Proof. split; [| split]; cbn; apply constant_encloses, fraction_is_in. Qed.

Lemma zero_in_symmetric r i : is_in r i -> 0 <= r -> is_in 0 (symmetric i).
Proof. intros h p. apply (symmetric_is_in r); [exact h |]. now rewrite Rabs_R0. Qed.

(** How far something is off along a unit vector. *)
Lemma off_by_encloses ball r i unit c f q q' : (ball < balls)%nat -> norm (of_ball t ball) <= r -> is_in r i ->
  v_is_in c unit -> Rabs (dot c (of_ball t ball)) <= norm (of_ball t ball) -> enc f q q' ->
  enc (f_add prec f (off_by prec ball i unit)) q (q' + dot c (of_ball t ball)).
Proof.
  intros l small hr hc below e. replace q with (q + 0) by ring. apply add_encloses; [exact e |].
  assert (p := norm_is_positive (of_ball t ball)).
  split; [apply (integer_is_in prec 0) | split; [apply (zero_in_symmetric r); [exact hr | lra] | split]].
  - apply (symmetric_is_in r); [exact hr | lra].
  - exists (Change 0 (fun b => if Nat.eqb b ball then c else Vec 0 0 0)). split.
    + split; [apply (integer_is_in prec 0) | now apply b_only_holds].
    + unfold sloped, moved. cbn [of_place of_ball]. rewrite sum_over_one by exact l. ring.
Qed.

Lemma v_within_encloses ball q V u u' : (ball < balls)%nat -> norm (of_ball t ball) <= Q2R q -> v_encloses V u u' ->
  v_encloses (v_within prec ball q V) u (plus u' (of_ball t ball)).
Proof.
  intros l small [a [b c]]. unfold v_within. destruct (Qeq_bool q 0) eqn:z.
  - apply zero_of in z. rewrite (norm_is_zero (of_ball t ball)), plus_zero by (rewrite <- z; exact small).
    split; [| split]; assumption.
  - destruct (coordinates_are_below (of_ball t ball)) as [x [y w]].
    assert (ex : forall v, dot (Vec 1 0 0) v = vx v) by (intros [v1 v2 v3]; unfold dot; cbn; ring).
    assert (ey : forall v, dot (Vec 0 1 0) v = vy v) by (intros [v1 v2 v3]; unfold dot; cbn; ring).
    assert (ez : forall v, dot (Vec 0 0 1) v = vz v) by (intros [v1 v2 v3]; unfold dot; cbn; ring).
    assert (one_in := integer_is_in prec 1). assert (zero_in' := integer_is_in prec 0).
    assert (r_in := fraction_is_in prec q).
    split; [| split]; cbn [vx vy vz plus].
    + rewrite <- (ex (of_ball t ball)). apply (off_by_encloses _ (Q2R q)); try assumption.
      * exact (conj one_in (conj zero_in' zero_in')).
      * rewrite ex. exact x.
    + rewrite <- (ey (of_ball t ball)). apply (off_by_encloses _ (Q2R q)); try assumption.
      * exact (conj zero_in' (conj one_in zero_in')).
      * rewrite ey. exact y.
    + rewrite <- (ez (of_ball t ball)). apply (off_by_encloses _ (Q2R q)); try assumption.
      * exact (conj zero_in' (conj zero_in' one_in)).
      * rewrite ez. exact w.
Qed.

Lemma around_is_in x x' r i j : is_in x i -> is_in r j -> Rabs (x' - x) <= r -> is_in x' (add prec i (symmetric j)).
Proof.
  intros a b c. replace x' with (x + (x' - x)) by ring. apply add_is_in; [exact a |]. now apply (symmetric_is_in r).
Qed.

Lemma v_turned_encloses n angle e i V u u' : norm n = 1 -> Rabs angle <= e -> e < 1 -> is_in e i ->
  of_ball t 1 = moves_about n angle ->
  v_encloses V u u' -> v_encloses (v_turned prec i V) u (turn_about n angle u').
Proof.
  intros unit he small hi ball [[a [b [c [k [[hk kb] ek]]]]] [[a1 [b1 [c1 [k1 [[hk1 kb1] ek1]]]]] [a2 [b2 [c2 [k2
    [[hk2 kb2] ek2]]]]]]].
  assert (up : 0 <= cos angle).
  { assert (p := PI2_3_2). assert (h := Rle_abs angle). assert (h' := Rle_abs (- angle)). rewrite Rabs_Ropp in h'.
    apply cos_ge_0; lra. }
  destruct (turn_about_is_cross n angle u' unit up) as [d [hd eq]].
  set (change := symmetric (mul prec i (norm_of prec (Vec (over (vx V)) (over (vy V)) (over (vz V)))))).
  assert (r : is_in (e * norm u') (mul prec i (norm_of prec (Vec (over (vx V)) (over (vy V)) (over (vz V)))))).
  { apply mul_is_in; [exact hi |]. apply norm_of_is_in. exact (conj c (conj c1 c2)). }
  assert (little : Rabs angle * norm u' <= e * norm u') by (apply Rmult_le_compat_r;
    [apply norm_is_positive | exact he]).
  assert (near : forall x x' j, is_in x j -> Rabs (x' - x) <= Rabs angle * norm u' -> is_in x' (add prec j change)).
  { intros x x' j h1 h2. apply (around_is_in x x' (e * norm u')); [exact h1 | exact r | lra]. }
  assert (same : forall x j, is_in x j -> is_in x (add prec j change)).
  { intros x j h. apply (near x x j h). rewrite Rminus_diag_eq, Rabs_R0 by reflexivity.
    apply Rmult_le_pos; [apply Rabs_pos | apply norm_is_positive]. }
  assert (move := turn_about_moves_little n angle u' unit).
  destruct (coordinates_are_below (minus (turn_about n angle u') u')) as [m1 [m2 m3]].
  destruct (coordinates_are_below d) as [d1 [d2 d3]].
  assert (hx : is_in (vx (plus u' d)) (add prec (over (vx V)) change)).
  { apply (near (vx u')); [exact c |]. cbn. replace (vx u' + vx d - vx u') with (vx d) by ring. lra. }
  assert (hy : is_in (vy (plus u' d)) (add prec (over (vy V)) change)).
  { apply (near (vy u')); [exact c1 |]. cbn. replace (vy u' + vy d - vy u') with (vy d) by ring. lra. }
  assert (hz : is_in (vz (plus u' d)) (add prec (over (vz V)) change)).
  { apply (near (vz u')); [exact c2 |]. cbn. replace (vz u' + vz d - vz u') with (vz d) by ring. lra. }
  assert (zero_in' := integer_is_in prec 0).
  assert (part : forall f q q' q'' g unit k, is_in q (mid f) -> is_in q (over f) ->
    is_in q'' (add prec (over f) change) ->
      in_slopes k f -> sloped k t q q' -> v_is_in g unit -> q'' = q' + dot g (of_ball t 1) ->
      enc (Form (mid f) (add prec (over f) change) (slope f) (b_add prec (slopes f) (b_only 1 unit))) q q'').
  { intros f q q' q'' g unit0 l h1 h2 h3 [h4 h5] h6 h7 h8.
    split; [exact h1 | split; [now apply same | split; [exact h3 |]]].
    exists (k_plus l (Change 0 (fun b => if Nat.eqb b 1 then g else Vec 0 0 0))). split; [split |].
    - cbn [of_place k_plus slope]. rewrite Rplus_0_r. exact h4.
    - apply b_add_holds; [exact h5 | now apply b_only_holds].
    - unfold sloped in *. rewrite moved_plus. unfold moved at 2. cbn [of_place of_ball].
      rewrite sum_over_one by (unfold balls; lia). rewrite h8, h6. ring. }
  split; [| split].
  - apply (part _ _ (vx u') _ (Vec 0 (vz (plus u' d)) (- vy (plus u' d))) _ k); try assumption.
    + exact (near _ _ _ c (Rle_trans _ _ _ m1 move)).
    + exact (conj hk kb).
    + exact (conj zero_in' (conj hz (neg_is_in _ _ hy))).
    + rewrite eq, ball. generalize (moves_about n angle), (plus u' d). intros [w1 w2 w3] [v1 v2 v3]. unfold dot. cbn.
      ring.
  - apply (part _ _ (vy u') _ (Vec (- vz (plus u' d)) 0 (vx (plus u' d))) _ k1); try assumption.
    + exact (near _ _ _ c1 (Rle_trans _ _ _ m2 move)).
    + exact (conj hk1 kb1).
    + exact (conj (neg_is_in _ _ hz) (conj zero_in' hx)).
    + rewrite eq, ball. generalize (moves_about n angle), (plus u' d). intros [w1 w2 w3] [v1 v2 v3]. unfold dot. cbn.
      ring.
  - apply (part _ _ (vz u') _ (Vec (vy (plus u' d)) (- vx (plus u' d)) 0) _ k2); try assumption.
    + exact (near _ _ _ c2 (Rle_trans _ _ _ m3 move)).
    + exact (conj hk2 kb2).
    + exact (conj hy (conj (neg_is_in _ _ hx) zero_in')).
    + rewrite eq, ball. generalize (moves_about n angle), (plus u' d). intros [w1 w2 w3] [v1 v2 v3]. unfold dot. cbn.
      ring.
Qed.

Ltac by_angle := intros h [a [b c]]; assert (hc := cos_encloses prec t _ _ _ h);
  assert (hs := sin_encloses prec t _ _ _ h); split; [| split]; cbn; by_parts.

Lemma rot_x_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_x prec (f_cos prec F) (f_sin prec F) V) (rot_x q u) (rot_x q' u').
Proof. by_angle. Qed.

Lemma rot_y_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_y prec (f_cos prec F) (f_sin prec F) V) (rot_y q u) (rot_y q' u').
Proof. by_angle. Qed.

Lemma rot_z_encloses F q q' V u u' : enc F q q' -> v_encloses V u u' ->
  v_encloses (f_rot_z prec (f_cos prec F) (f_sin prec F) V) (rot_z q u) (rot_z q' u').
Proof. by_angle. Qed.

Lemma v_dot_encloses V W u u' w w' : v_encloses V u u' -> v_encloses W w w' ->
  enc (v_dot prec V W) (dot u w) (dot u' w').
Proof. intros [a [b c]] [d [e f]]. unfold v_dot, dot. by_parts. Qed.

Lemma one_encloses : enc (constant prec (one prec)) 1 1.
Proof. apply constant_encloses, (integer_is_in prec 1). Qed.

Lemma zero_encloses : enc (constant prec (zero prec)) 0 0.
Proof. apply constant_encloses, (integer_is_in prec 0). Qed.

Lemma turn_about_encloses N n F q q' V u u' : v_encloses N n n -> enc F q q' -> v_encloses V u u' ->
  v_encloses (f_turn_about prec N F V) (turn_about n q u) (turn_about n q' u').
Proof.
  intros hn h hv. assert (hc := cos_encloses prec t _ _ _ h). assert (hs := sin_encloses prec t _ _ _ h).
  assert (one_enc := one_encloses). unfold f_turn_about, turn_about. cbv zeta.
  repeat first [assumption | apply v_add_encloses | apply v_scale_encloses | apply v_cross_encloses
    | apply v_dot_encloses |
    apply mul_encloses | apply sub_encloses].
Qed.

Lemma turn_by_encloses U u u' W w w' V x x' : v_encloses U u u' -> enc W w w' -> v_encloses V x x' ->
  v_encloses (f_turn_by prec U W V) (turn_by (Quaternion u w) x) (turn_by (Quaternion u' w') x').
Proof.
  intros hu hw hv. assert (two := constant_encloses prec t 2 _ (integer_is_in prec 2)).
    assert (one_enc := one_encloses).
  unfold f_turn_by, turn_by. cbv zeta. cbn [vector_part scalar_part]. rewrite <- (Rmult_1_l (/ (dot u u + w * w))),
    <- (Rmult_1_l (/ (dot u' u' + w' * w'))).
  repeat first [assumption | apply v_scale_encloses | apply div_encloses | apply v_add_encloses
    | apply v_cross_encloses |
    apply v_dot_encloses | apply mul_encloses | apply sub_encloses | apply add_encloses].
Qed.

Lemma fractions_are_in u : v_is_in (real_vec u) (fractions prec u).
Proof. exact (conj (fraction_is_in prec _) (conj (fraction_is_in prec _) (fraction_is_in prec _))). Qed.

Lemma unit_encloses u : v_encloses (unit_form prec u) (unit_along (real_vec u)) (unit_along (real_vec u)).
Proof.
  assert (k : is_in (/ norm (real_vec u)) (div prec (one prec) (norm_of prec (fractions prec u)))).
  { rewrite <- (Rmult_1_l (/ _)). apply div_is_in; [apply (integer_is_in prec 1)
    | apply norm_of_is_in, fractions_are_in]. }
  split; [| split]; cbn; apply constant_encloses, mul_is_in; first [exact k | apply fraction_is_in].
Qed.

(** A pose whose [turn] is one: it is linear and keeps lengths and angles. *)
Definition is_rigid (P : pose) : Prop :=
  (forall u, turn P u = combination u (turn P unit_x) (turn P unit_y) (turn P unit_z)) /\
  (forall u w, dot (turn P u) (turn P w) = dot u w).

Definition images_enclose (V : vec (vec form)) (f f' : vec R -> vec R) : Prop :=
  v_encloses (vx V) (f unit_x) (f' unit_x) /\ v_encloses (vy V) (f unit_y) (f' unit_y) /\
  v_encloses (vz V) (f unit_z) (f' unit_z).

Definition pose_encloses (f : pose_form) (P P' : pose) : Prop :=
  v_encloses (place f) (position P) (position P') /\ images_enclose (images f) (turn P) (turn P').

Lemma columns_of_encloses F f f' : (forall V u, v_encloses V u u -> v_encloses (F V) (f u) (f' u)) ->
  images_enclose (columns_of prec F) f f'.
Proof.
  assert (one_enc := one_encloses). assert (zero_enc := zero_encloses).
  intros h. split; [| split]; apply h; (split; [| split]); assumption.
Qed.

Section Pose.

(** A machine that deviates, and where its platform is while it is meant to be at [to_s]; and the machine as it is
    stated, at [at_m]. *)
Variables (at_m to_s : pose) (p : pose_form).
Hypotheses (m_is_rigid : is_rigid at_m) (s_is_rigid : is_rigid to_s) (p_encloses : pose_encloses p at_m to_s).
Variables (m : machine) (B : built) (off axis : vec R) (angle : R).
Hypotheses (axis_is_unit : norm axis = 1)
  (angle_is_small : Rabs angle <= Rabs (value (fun _ => 0) (of_orientation (tolerance m))))
  (angle_is_below_1 : Rabs (value (fun _ => 0) (of_orientation (tolerance m))) < 1).
Hypotheses (ball_of_position : of_ball t 0 = off) (ball_of_turn : of_ball t 1 = moves_about axis angle)
  (ball_of_load_point : of_ball t 2 = minus (load_at B) (real_vec (load_point m)))
  (ball_of_base : forall i, (i < 6)%nat ->
    of_ball t (3 + 2 * i) = minus (fst (nth6 (anchors B) i)) (real_vec (base (nth6 (cables m) i))))
  (ball_of_platform : forall i, (i < 6)%nat ->
    of_ball t (4 + 2 * i) = minus (snd (nth6 (anchors B) i)) (real_vec (platform (nth6 (cables m) i)))).
Hypotheses (off_is_small : norm off <= of_position (tolerance m)) (B_is_built : is_built m B).

Let turned_off (u : vec R) := turn_about axis angle (turn to_s u).
Let A := itself m.
Let at_s := Pose (plus (position to_s) off) turned_off.
Let R_form := orientation_form prec m (images p).
Let P_form := position_form prec m (place p).

Lemma turned_off_is_linear u : turned_off u = combination u (turned_off unit_x) (turned_off unit_y) (turned_off unit_z).
Proof. unfold turned_off. rewrite (proj1 s_is_rigid u). apply turn_about_is_linear. Qed.

Lemma angle_is_in : is_in (Rabs (value (fun _ => 0) (of_orientation (tolerance m)))) (angle_of prec m).
Proof.
  apply abs_is_in, (eval_encloses prec t _ (fun _ => 0) (fun _ => 0)). intros _. exact zero_encloses.
Qed.

Lemma orientation_encloses : images_enclose R_form (turn at_m) turned_off.
Proof.
  destruct p_encloses as [_ [x [y z]]]. unfold R_form, orientation_form.
  destruct (is_zero_number (of_orientation (tolerance m))) eqn:still.
  - assert (zero := no_angle _ _ still angle_is_small).
    assert (same : forall u, turned_off u = turn to_s u).
    { intros u. unfold turned_off. rewrite zero. apply turn_about_by_nothing. }
    unfold images_enclose. rewrite !same. split; [| split]; assumption.
  - assert (h := angle_is_in). split; [| split]; (eapply v_turned_encloses; eassumption).
Qed.

Lemma turned_encloses U u u' : v_encloses U u u' ->
  v_encloses (turned prec R_form U) (turn at_m u) (turn at_s u').
Proof.
  intros h. assert (h' := h). destruct h' as [hx [hy hz]]. destruct orientation_encloses as [x [y z]].
  change (turn at_s u') with (turned_off u').
  rewrite (proj1 m_is_rigid u), (turned_off_is_linear u'). unfold turned, combination.
  repeat first [apply v_add_encloses | apply v_scale_encloses; assumption].
Qed.

Lemma position_encloses : v_encloses P_form (position at_m) (position at_s).
Proof.
  unfold at_s. cbn [position]. rewrite <- ball_of_position.
  apply v_within_encloses; [unfold balls; lia | rewrite ball_of_position; exact off_is_small | apply p_encloses].
Qed.

(** A point that is near to a stated one. *)
Lemma point_encloses (point : vec Q) (within : Q) ball u : (ball < balls)%nat ->
  of_ball t ball = minus u (real_vec point) ->
  near within u point -> v_encloses (v_within prec ball within (v_rational prec point)) (real_vec point) u.
Proof.
  intros l e h. rewrite <- (plus_of_minus u (real_vec point)) at 1. rewrite <- e.
  apply v_within_encloses; [exact l | rewrite e; exact h | apply v_rational_encloses].
Qed.

Lemma anchors_are_near i : (i < 6)%nat ->
  near (fst (nth6 (of_anchors (tolerance m)) i)) (fst (nth6 (anchors B) i)) (base (nth6 (cables m) i)) /\
  near (snd (nth6 (of_anchors (tolerance m)) i)) (snd (nth6 (anchors B) i)) (platform (nth6 (cables m) i)).
Proof.
  destruct B_is_built as [h _]. revert i. unfold all6, fold6, zip6 in h. cbn [at1 at2 at3 at4 at5 at6] in h.
  decompose [and] h. apply each_of_six; cbn [nth6]; split; assumption.
Qed.

(** ** The load at a pose *)

Lemma range_is_in f q q' : enc f q q' -> is_in q' (range prec reach f).
Proof. intros h. apply (tight_encloses prec t reach f q q' zero_in t_in as_many t_within) in h. apply h. Qed.

Lemma size_is_in V u u' : v_encloses V u u' -> is_in (norm u') (size prec reach V).
Proof.
  intros [a [b c]]. unfold size. apply norm_of_is_in.
  exact (conj (range_is_in _ _ _ a) (conj (range_is_in _ _ _ b) (range_is_in _ _ _ c))).
Qed.

Lemma arm_encloses U u u' : v_encloses U u u' ->
  v_encloses (arm_form prec reach R_form m U) (arm A at_m u) (arm B at_s u').
Proof.
  intros h. destruct B_is_built as [_ hp]. apply v_tight_encloses. unfold arm. apply turned_encloses.
  apply v_sub_encloses; [exact h |]. now apply point_encloses; [unfold balls; lia | |].
Qed.

Lemma arm_of_rational_encloses point :
  v_encloses (arm_form prec reach R_form m (v_rational prec point)) (arm A at_m (real_vec point)) (arm B at_s
    (real_vec point)).
Proof. apply arm_encloses, v_rational_encloses. Qed.

Lemma covector_encloses Y y r r' V : v_encloses (fst Y) (fst y) (fst y) -> v_encloses (snd Y) (snd y) (snd y) ->
  v_encloses V r r' -> v_encloses (covector_form prec Y V) (covector y r) (covector y r').
Proof. intros a b c. unfold covector_form, covector. apply v_add_encloses; [exact a |]. now apply v_cross_encloses. Qed.

Lemma seen_encloses a H h h' : v_encloses H h h' ->
  v_encloses (seen_form prec R_form a H) (seen_from a (turn at_m) h) (seen_from a (turn at_s) h').
Proof.
  intros e. destruct a; [exact e |]. destruct orientation_encloses as [x [y z]].
  split; [| split]; (apply v_dot_encloses; [assumption | exact e]).
Qed.

Lemma turn_is_sum u w : turn at_s (plus u w) = plus (turn at_s u) (turn at_s w).
Proof.
  change (turn at_s) with turned_off.
  rewrite (turned_off_is_linear (plus u w)), (turned_off_is_linear u), (turned_off_is_linear w).
    apply combination_of_plus.
Qed.

Lemma turn_keeps_norm u : norm (turn at_s u) = norm u.
Proof.
  change (turn at_s) with turned_off. unfold norm, turned_off. f_equal.
  rewrite turn_about_keeps_dot by exact axis_is_unit. apply s_is_rigid.
Qed.

Lemma dot_in_axes a h u : dot h (in_axes a at_s u) = dot (seen_from a (turn at_s) h) u.
Proof.
  destruct a; cbn [in_axes seen_from]; [reflexivity |].
  change (turn at_s) with turned_off. rewrite (turned_off_is_linear u). apply dot_of_combination.
Qed.

(** What a part is of: a form of what one wrench makes at m and at s, and what others add to that at s. *)
Definition part_holds (p : part) (y : R) : Prop :=
  exists q q', enc (fst p) q q' /\ is_in (y - q') (snd p).

Lemma only_holds x i : is_in x i -> part_holds (only prec i) x.
Proof.
  intros h. exists 0, 0. split; [apply constant_encloses, (integer_is_in prec 0) |]. now rewrite Rminus_0_r.
Qed.

Lemma middle_is_in l u : is_in ((Q2R l + Q2R u) * / 2) (middle prec l u).
Proof.
  replace ((Q2R l + Q2R u) * / 2) with (Q2R ((l + u) * (1 # 2))); [apply fraction_is_in |].
  rewrite Q2R_mult, Q2R_plus. unfold Q2R at 3. cbn [Qnum Qden]. lra.
Qed.

Lemma half_range_is_in l u : is_in ((Q2R u - Q2R l) * / 2) (half_range prec l u).
Proof.
  replace ((Q2R u - Q2R l) * / 2) with (Q2R ((u - l) * (1 # 2))); [apply fraction_is_in |].
  rewrite Q2R_mult, Q2R_minus. unfold Q2R at 3. cbn [Qnum Qden]. lra.
Qed.

Lemma multiples_hold l u f q q' : enc f q q' ->
  enc (fst (multiples prec reach l u f)) ((Q2R l + Q2R u) * / 2 * q) ((Q2R l + Q2R u) * / 2 * q') /\
  is_in ((Q2R u - Q2R l) * / 2 * Rabs q') (snd (multiples prec reach l u f)).
Proof.
  intros h. cbn [multiples fst snd]. split.
  - apply mul_encloses; [apply constant_encloses, middle_is_in | exact h].
  - apply mul_is_in; [apply half_range_is_in |]. eapply abs_is_in, range_is_in, h.
Qed.

Lemma vectors_hold set H h h' u : v_encloses H h h' -> in_vectors set u ->
  part_holds (vectors_part prec reach set H) (dot h' u).
Proof.
  intros e hu. assert (rational := v_rational_encloses). destruct set as [r | r n | d l w]; cbn [vectors_part].
  - apply only_holds. apply (symmetric_is_in (Q2R r * norm h')); [| now apply ball_is_below].
    apply mul_is_in; [apply fraction_is_in | now apply (size_is_in _ h)].
  - apply only_holds. assert (N := size_is_in _ _ _ (rational n)).
    assert (top : is_in (Q2R r * norm (cross (real_vec n) h'))
        (mul prec (fraction prec r) (size prec reach (v_cross prec (v_rational prec n) H)))).
    { apply mul_is_in; [apply fraction_is_in |]. eapply size_is_in, v_cross_encloses; [apply rational | exact e]. }
    destruct (Req_dec (norm (real_vec n)) 0) as [z | z].
    + apply (symmetric_is_in (Rabs (dot h' u))); [| apply Rle_refl].
      apply div_by_0_is_in; [eexists; exact top | rewrite <- z; exact N].
    + apply (symmetric_is_in (Q2R r * norm (cross (real_vec n) h') / norm (real_vec n))).
      * now apply div_is_in.
      * now apply disc_is_below.
  - destruct (segment_is_near d l w u h' hu) as [f [near eq]].
    assert (a : enc (f_div prec (v_dot prec H (v_rational prec d)) (constant prec (size prec reach (v_rational prec
      d))))
        (dot h (real_vec d) / norm (real_vec d)) (dot h' (real_vec d) / norm (real_vec d))).
    { apply div_encloses; [apply v_dot_encloses; [exact e | apply rational] |]. apply constant_encloses.
      eapply size_is_in, rational. }
    destruct (multiples_hold l w _ _ _ a) as [x y]. eexists; eexists. split; [exact x |]. cbn [snd].
    eapply symmetric_is_in; [exact y |]. rewrite eq, <- Rmult_minus_distr_r, Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | exact near].
Qed.

Lemma weight_holds Y y l u g c r mass center : v_encloses (fst Y) (fst y) (fst y) ->
  v_encloses (snd Y) (snd y) (snd y) ->
  Q2R l <= mass <= Q2R u -> norm (minus center (real_vec c)) <= Q2R r ->
  part_holds (weight_part prec reach R_form m Y l u g c r)
    (along_row y (force_at B at_s center (times mass (real_vec g)))).
Proof.
  intros hf hm hmass hc. rewrite along_force.
  set (delta := minus center (real_vec c)) in hc.
  assert (eq : dot (covector y (arm B at_s center)) (times mass (real_vec g)) =
    mass * (dot (covector y (arm B at_s (real_vec c))) (real_vec g) + dot (turn at_s delta) (cross (real_vec g) (snd
      y)))).
  { replace (arm B at_s center) with (plus (arm B at_s (real_vec c)) (turn at_s delta)).
    - apply dot_of_moved.
    - unfold arm. rewrite <- turn_is_sum. f_equal. symmetry. apply minus_in_two_steps. }
  assert (below : Rabs (dot (turn at_s delta) (cross (real_vec g) (snd y))) <= Q2R r * norm (cross (real_vec g) (snd
    y))).
  { apply Rle_trans with (1 := dot_is_below _ _). apply Rmult_le_compat_r; [apply norm_is_positive |].
    rewrite turn_keeps_norm. exact hc. }
  assert (a := v_dot_encloses _ _ _ _ _ _ (covector_encloses Y y _ _ _ hf hm (arm_of_rational_encloses c))
    (v_rational_encloses g)).
  destruct (multiples_hold l u _ _ _ a) as [x z]. eexists; eexists. split; [exact x |]. cbn [weight_part snd].
  rewrite eq. eapply symmetric_is_in; [| now apply weight_is_near; [exact hmass | exact below]].
  apply add_is_in; [exact z |]. apply mul_is_in.
  - apply add_is_in; [eapply abs_is_in, middle_is_in | apply half_range_is_in].
  - apply mul_is_in; [apply fraction_is_in |]. eapply size_is_in.
    apply v_cross_encloses; [apply v_rational_encloses | exact hm].
Qed.

(** Two covectors and load cases: what a wrench makes is [dot h (force w) + dot k (moment w)]. *)
Lemma case_encloses H K h h' k k' w : v_encloses H h h' -> v_encloses K k k' ->
  enc (case_form prec H K w) (along_row (h, k) (real_wrench w)) (along_row (h', k') (real_wrench w)).
Proof.
  intros a b. unfold case_form, along_row. cbn [fst snd real_wrench force moment].
  apply add_encloses; apply v_dot_encloses; try assumption; apply v_rational_encloses.
Qed.

Lemma hull_holds (y : row) (d : R) (f : vec Q * vec Q -> interval) l w : in_hull l w ->
  (forall u, is_in (along_row y (real_wrench u) - d) (f u)) -> is_in (along_row y w - d) (hull f l).
Proof.
  intros h hf. revert w h. induction l as [| a l IH]; intros w h; [contradiction h |].
  destruct l as [| b l].
  - cbn [in_hull] in h. subst w. apply hf.
  - change (exists (t : R) (u : wrench), 0 <= t <= 1 /\ in_hull (b :: l) u /\
      w = wrench_plus (wrench_times t (real_wrench a)) (wrench_times (1 - t) u)) in h.
    destruct h as [x [u [[lo hi] [hu eq]]]]. subst w. rewrite along_plus, !along_times.
    change (hull f (a :: b :: l)) with (I.join (f a) (hull f (b :: l))).
    assert (above := join_left _ _ (hull f (b :: l)) (hf a)). assert (below := join_right _ (f a) _ (IH u hu)).
    apply (between_is_in _ _ _ _ above below).
    set (p1 := along_row y (real_wrench a)). set (p2 := along_row y u).
    unfold Rmin, Rmax. destruct (Rle_dec (p1 - d) (p2 - d)); nra.
Qed.

Lemma cases_hold H K h h' k k' l w : v_encloses H h h' -> v_encloses K k k' -> in_hull l w ->
  part_holds (cases_part prec reach H K l) (along_row (h', k') w).
Proof.
  intros a b hw. destruct l as [| u l]; [contradiction hw |]. cbn [cases_part].
  exists (along_row (h, k) (real_wrench u)), (along_row (h', k') (real_wrench u)). split; [now apply case_encloses |].
  cbn [snd]. apply hull_holds; [exact hw |]. intros c.
  replace (along_row (h', k') (real_wrench c) - along_row (h', k') (real_wrench u)) with
    (along_row (h', k') (real_wrench (q_minus (fst c) (fst u), q_minus (snd c) (snd u)))).
  - eapply range_is_in, case_encloses; eassumption.
  - destruct c as [[c1 c2 c3] [c4 c5 c6]], u as [[u1 u2 u3] [u4 u5 u6]].
    unfold along_row, real_wrench, q_minus, real_vec, dot. cbn [fst snd force moment vx vy vz].
    rewrite !Q2R_minus. ring.
Qed.

(** A row's two vectors. *)
Definition row_of (c : nat -> R) : row := (Vec (c 0%nat) (c 1%nat) (c 2%nat), Vec (c 3%nat) (c 4%nat) (c 5%nat)).

Lemma along_row_of c w : along_row (row_of c) w = along_six c (six_of w).
Proof. unfold along_row, along_six, row_of, dot, SixEquations.total. cbn. ring. Qed.

Section Row.

Variables (c : nat -> R) (cI : six interval).
Hypothesis hc : forall k, (k < 6)%nat -> is_in (c k) (nth6 cI k).

Lemma row_encloses :
  v_encloses (fst (row_form prec cI)) (fst (row_of c)) (fst (row_of c)) /\
  v_encloses (snd (row_form prec cI)) (snd (row_of c)) (snd (row_of c)).
Proof.
  split; (split; [| split]); apply constant_encloses;
    first [apply (hc 0%nat); lia | apply (hc 1%nat); lia | apply (hc 2%nat); lia | apply (hc 3%nat); lia |
      apply (hc 4%nat); lia | apply (hc 5%nat); lia].
Qed.

Lemma item_holds i w : in_item B at_s i w ->
  part_holds (item_part prec reach R_form m cI i) (along_row (row_of c) w).
Proof.
  intros h. destruct row_encloses as [hf hm].
  assert (cov := fun point => covector_encloses _ _ _ _ _ hf hm (arm_of_rational_encloses point)).
  destruct i as [center shift shape | l u g point r | set a point | set a | cases a point].
  - cbn [item_part]. rewrite along_row_of. unfold ellipsoid_part.
    destruct (squares 6 (list_of (map6 list_of shape))) as [l |] eqn:e; [| apply only_holds, nai_has_all].
    exists (along_six c (map6 Q2R center)), (along_six c (map6 Q2R center)).
    split; [now apply constant_encloses, along_is_in | exact (ellipsoid_is_in B at_s c cI center shift shape w l hc e
      h)].
  - destruct h as [mass [center [hmass [near ->]]]]. apply weight_holds; assumption.
  - destruct h as [u [hu ->]]. rewrite along_force, dot_in_axes. eapply vectors_hold; [| exact hu].
    apply seen_encloses, cov.
  - destruct h as [u [hu ->]]. rewrite along_moment, dot_in_axes. eapply vectors_hold; [| exact hu].
    apply seen_encloses, hm.
  - destruct h as [u [hu ->]]. rewrite along_plus, along_force, along_moment, !dot_in_axes.
    eapply (cases_hold _ _ _ _ _ _ cases u); [apply seen_encloses, cov | apply seen_encloses, hm | exact hu].
Qed.

Lemma load_holds l : forall w, in_items B at_s l w ->
  part_holds (load_part prec reach R_form m cI l) (along_row (row_of c) w).
Proof.
  induction l as [| i l IH]; intros w h.
  - cbn [in_items] in h. subst w. change (part_holds (only prec (zero prec)) (along_row (row_of c) (pure_moment (Vec 0
    0 0)))).
    apply only_holds. replace (along_row _ _) with 0; [apply (integer_is_in prec 0) |].
    rewrite along_moment. unfold dot. cbn [vx vy vz]. ring.
  - destruct h as [a [b [-> [ha hb]]]].
    destruct (item_holds i a ha) as [q [q' [e d]]]. destruct (IH b hb) as [p1 [p1' [e1 d1]]].
    exists (q + p1), (q' + p1'). rewrite along_plus.
    change (load_part prec reach R_form m cI (i :: l)) with
      (let p := item_part prec reach R_form m cI i in
       let t := load_part prec reach R_form m cI l in (f_add prec (fst p) (fst t), add prec (snd p) (snd t))).
    cbv zeta. cbn [fst snd]. split; [now apply add_encloses |].
    replace (along_row (row_of c) a + along_row (row_of c) b - (q' + p1')) with
      ((along_row (row_of c) a - q') + (along_row (row_of c) b - p1')) by ring.
    now apply add_is_in.
Qed.

End Row.

(** ** A pose *)

Lemma columns_enclose i k : (i < 6)%nat -> (k < 6)%nat ->
  enc (nth6 (nth6 (column_forms prec reach R_form P_form m) i) k)
      (densities_matrix A at_m k i) (densities_matrix B at_s k i).
Proof.
  intros li lk. unfold column_forms, densities_matrix. rewrite !nth6_zip.
  replace (nth6 (Six 0%nat 1%nat 2%nat 3%nat 4%nat 5%nat) i) with i by (clear lk; revert i li; apply each_of_six;
    reflexivity).
  destruct (anchors_are_near i li) as [hb hp].
  assert (eb := ball_of_base i li). assert (ep := ball_of_platform i li).
  replace (nth6 (anchors A) i) with (real_vec (base (nth6 (cables m) i)), real_vec (platform (nth6 (cables m) i)))
    by (unfold A, itself; cbn [anchors]; now rewrite nth6_map).
  generalize dependent (nth6 (of_anchors (tolerance m)) i). generalize dependent (nth6 (cables m) i).
  generalize dependent (nth6 (anchors B) i). intros a c eb ep w hb hp.
  assert (u := point_encloses (platform c) (snd w) (4 + 2 * i) (snd a) ltac:(unfold balls; lia) ep hp).
  assert (d : v_encloses (v_tight prec reach (v_sub prec (v_add prec P_form
      (turned prec R_form (v_within prec (4 + 2 * i) (snd w) (v_rational prec (platform c)))))
      (v_within prec (3 + 2 * i) (fst w) (v_rational prec (base c)))))
    (cable_vector at_m (real_vec (base c), real_vec (platform c))) (cable_vector at_s a)).
  { apply v_tight_encloses. unfold cable_vector. cbn [fst snd].
    apply v_sub_encloses; [| apply point_encloses; [unfold balls; lia | exact eb | exact hb]].
    apply v_add_encloses; [apply position_encloses | now apply turned_encloses]. }
  assert (r := arm_encloses _ _ _ u).
  assert (x := v_cross_encloses _ _ _ _ _ _ r d).
  destruct d as [dx [dy dz]], x as [xx [xy xz]].
  revert k lk. apply each_of_six; cbn [nth6 column_form density_column at1 at2 at3 at4 at5 at6]; assumption.
Qed.

Lemma f_sum_encloses l r r' : (forall k, (k < 6)%nat -> enc (nth6 l k) (r k) (r' k)) ->
  enc (f_sum prec l) (total r) (total r').
Proof.
  intros h. unfold SixEquations.total, f_sum, fold6.
  repeat apply add_encloses; first [apply (h 0%nat); lia | apply (h 1%nat); lia | apply (h 2%nat); lia |
    apply (h 3%nat); lia | apply (h 4%nat); lia | apply (h 5%nat); lia].
Qed.

Lemma check_pose_turns tension_margin length_margin x f :
  check_pose prec reach m tension_margin length_margin x f = true -> is_turn f = true.
Proof. unfold check_pose. cbv zeta. rewrite andb_true_iff. tauto. Qed.

Lemma number_is_in scale z : is_in (Q2R (z # Pos.pow 2 scale)) (number prec scale z).
Proof. apply fraction_is_in. Qed.

Lemma units_are_delta i j : (i < 6)%nat -> (j < 6)%nat -> IZR (nth6 (nth6 units i) j) = SixEquations.delta i j.
Proof.
  intros a b. revert j b. revert i a.
  apply (each_of_six (fun i => forall j, (j < 6)%nat -> IZR (nth6 (nth6 units i) j) = SixEquations.delta i j));
    apply each_of_six; reflexivity.
Qed.

(* So that Coq's kernel compares what these are applied to, before it looks into them. *)
Strategy 1000 [decide product error_ranges rest_ranges orientation_form position_form column_forms length_range].
Strategy 1000 [densities_matrix density_column pose_at SixEquations.total SixEquations.error6 along_six rest load_part].
Strategy expand [check_pose].

Theorem pose_is_sound tension_margin length_margin x :
  check_pose prec reach m tension_margin length_margin x p = true ->
  feasible_at m B tension_margin length_margin at_s.
Proof.
  intros h. unfold check_pose in h. cbv zeta in h. rewrite andb_true_iff in h. destruct h as [_ h].
  fold R_form P_form in h.
  set (columns := column_forms prec reach R_form P_form m) in h.
  set (CI := map6 (map6 (number prec (scale x))) (inverse x)) in h.
  set (xI := map6 (number prec (scale x)) (densities x)) in h.
  set (C := fun i k => Q2R (nth6 (nth6 (inverse x) i) k # Pos.pow 2 (scale x))).
  set (x0 := fun i => Q2R (nth6 (densities x) i # Pos.pow 2 (scale x))).
  set (D := densities_matrix B at_s). set (D' := densities_matrix A at_m).
  assert (hC : forall i k, is_in (C i k) (nth6 (nth6 CI i) k)).
  { intros i k. unfold CI. rewrite !nth6_map. apply number_is_in. }
  assert (hx : forall i, is_in (x0 i) (nth6 xI i)).
  { intros i. unfold xI. rewrite nth6_map. apply number_is_in. }
  assert (hcol : forall i k, (i < 6)%nat -> (k < 6)%nat -> enc (nth6 (nth6 columns i) k) (D' k i) (D k i)).
  { intros i k li lk. now apply columns_enclose. }
  assert (hCD : forall i j, (j < 6)%nat -> enc (nth6 (nth6 (product prec CI columns) i) j)
      (total (fun k => C i k * D' k j)) (total (fun k => C i k * D k j))).
  { intros i j l. unfold product. rewrite !nth6_map. apply f_sum_encloses. intros k lk. rewrite nth6_zip.
    apply mul_encloses; [apply constant_encloses, hC | now apply hcol]. }
  assert (hE : forall i, (i < 6)%nat -> forall j, (j < 6)%nat ->
      is_in (error6 C D i j) (nth6 (nth6 (error_ranges prec reach (product prec CI columns)) i) j)).
  { intros i li j lj. unfold error_ranges. rewrite !nth6_zip. apply (range_is_in _ (error6 C D' i j)).
    unfold SixEquations.error6. rewrite <- (units_are_delta i j) by assumption.
    apply sub_encloses; [apply constant_encloses, integer_is_in | now apply hCD]. }
  assert (hL : forall i, (i < 6)%nat -> is_in (length_of B at_s i) (nth6 (map6 (length_range prec reach) columns) i)).
  { intros i li. rewrite nth6_map. apply (range_is_in _ (norm (cable_vector at_m (nth6 (anchors A) i)))).
    apply sqrt_encloses, v_dot_encloses; (split; [| split]);
      first [apply (hcol i 0%nat) | apply (hcol i 1%nat) | apply (hcol i 2%nat)]; (exact li || lia). }
  destruct (decide_is_sound m tension_margin length_margin _ _ _ _ h (length_of B at_s) x0 (error6 C D) hL
    (fun i _ => hx i) hE) as [small [positive [lengths loads]]].
  apply (pose_is_feasible m B at_s tension_margin length_margin C x0
    (most (fun i => total (fun j => Rabs (error6 C D i j))))); try assumption.
  - apply (most_bounds (fun i => total (fun j => Rabs (error6 C D i j)))).
  - intros w hw. apply loads. intros i li. unfold rest_ranges. rewrite !nth6_zip. cbv zeta.
    replace (rest B at_s C x0 w i) with
      (along_six (C i) (six_of w) - total (fun j => total (fun k => C i k * D k j) * x0 j)).
    + rewrite <- along_row_of.
      destruct (load_holds (C i) (nth6 CI i) (fun k _ => hC i k) (load m) w hw) as [q [q' [e d]]].
      set (S := total (fun j => total (fun k => C i k * D k j) * x0 j)).
      replace (along_row (row_of (C i)) w - S) with ((q' - S) + (along_row (row_of (C i)) w - q')) by ring.
      apply add_is_in; [| exact d].
      apply (range_is_in _ (q - total (fun j => total (fun k => C i k * D' k j) * x0 j))).
      apply sub_encloses; [exact e |]. apply f_sum_encloses. intros j lj. rewrite nth6_zip.
      apply mul_encloses; [now apply hCD | apply constant_encloses, hx].
    + exact (rest_splits (C i) (nth6 (six_of w)) x0 D).
Qed.

End Pose.

(** ** Poses of parameters, and geodesics *)

Lemma vector_is_not_0 u : is_vector u = true -> real_vec u <> Vec 0 0 0.
Proof.
  unfold is_vector, real_vec. rewrite negb_true_iff. intros h e. injection e as x y z.
  assert (is0 : forall q, Q2R q = 0 -> Qeq_bool q 0 = true).
  { intros q hq. apply Qeq_bool_iff, eqR_Qeq. rewrite hq. unfold Q2R. cbn. lra. }
  rewrite (is0 _ x), (is0 _ y), (is0 _ z) in h. discriminate h.
Qed.

Lemma angles_are_rigid m v : has_axis (pose_angles m) = true -> is_rigid (pose_at m v).
Proof.
  intros axis. split; [intros [x y z]; unfold pose_at; cbn [turn]; destruct (pose_angles m);
    try (unfold combination, rot_z, rot_y, rot_x, plus, times, unit_x, unit_y, unit_z; cbn [vx vy vz]; f_equal; ring);
    apply turn_about_axis_is_linear |].
  assert (unit : forall q, cos q * cos q = 1 - sin q * sin q) by (intros q; assert (h := sin2_cos2 q);
    unfold Rsqr in h; lra).
  assert (X : forall q v1 v2, dot (rot_x q v1) (rot_x q v2) = dot v1 v2).
  { intros q [x y z] [x' y' z']. unfold dot, rot_x. cbn [vx vy vz]. assert (e := unit q).
    replace (x * x' + _ * _ + _ * _) with
      (x * x' + (cos q * cos q) * (y * y' + z * z') + (sin q * sin q) * (y * y' + z * z')) by ring. rewrite e. ring. }
  assert (Y : forall q v1 v2, dot (rot_y q v1) (rot_y q v2) = dot v1 v2).
  { intros q [x y z] [x' y' z']. unfold dot, rot_y. cbn [vx vy vz]. assert (e := unit q).
    replace (_ + y * y' + _) with
      (y * y' + (cos q * cos q) * (x * x' + z * z') + (sin q * sin q) * (x * x' + z * z')) by ring. rewrite e. ring. }
  assert (Z : forall q v1 v2, dot (rot_z q v1) (rot_z q v2) = dot v1 v2).
  { intros q [x y z] [x' y' z']. unfold dot, rot_z. cbn [vx vy vz]. assert (e := unit q).
    replace (_ + z * z') with
      (z * z' + (cos q * cos q) * (x * x' + y * y') + (sin q * sin q) * (x * x' + y * y')) by ring. rewrite e. ring. }
  intros u w. unfold pose_at. cbn [turn]. destruct (pose_angles m); try (apply turn_about_keeps_dot, unit_along_is_unit;
    now apply vector_is_not_0); repeat first [rewrite X | rewrite Y | rewrite Z]; reflexivity.
Qed.


Section Parameters.

Variables (p : nat -> form) (v v' : nat -> R).
Hypothesis p_encloses : forall i, enc (p i) (v i) (v' i).

Let value_encloses e : enc (eval prec p e) (value v e) (value v' e) := eval_encloses prec t p v v' p_encloses e.

Lemma posed_encloses m : pose_encloses (posed prec m p) (pose_at m v) (pose_at m v').
Proof.
  split; [split; [| split]; apply value_encloses |]. unfold pose_at. cbn [images posed turn].
  destruct (pose_angles m); cbn [rotation]; apply columns_of_encloses; intros V u h;
    repeat first [exact h | apply value_encloses | apply sub_encloses | apply rot_z_encloses | apply rot_y_encloses |
      apply rot_x_encloses | apply turn_about_encloses | apply unit_encloses].
Qed.

End Parameters.
End Offset.

End Precision.
End Poses.
