(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker computes of expressions encloses their values and slopes *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Loads Checker.
Import ListNotations.
Open Scope R_scope.

Module Enclosure (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module C := Checker.Checker F.
Import C.

(** A real number is in an interval. *)
Definition is_in (x : R) (i : interval) : Prop := contains (I.convert i) (Xreal x).

Lemma nothing_is_known i x : contains (I.convert i) Xnan -> is_in x i.
Proof. unfold is_in; destruct (I.convert i); simpl; tauto. Qed.

Lemma between_is_in x y z i : is_in x i -> is_in y i -> Rmin x y <= z <= Rmax x y -> is_in z i.
Proof.
  unfold is_in; destruct (I.convert i) as [| l u]; simpl; [tauto|].
  intros [a b] [c d] [e f].
  split; [destruct l | destruct u]; try exact I.
  - apply Rle_trans with (Rmin x y); [apply Rmin_glb; assumption | exact e].
  - apply Rle_trans with (Rmax x y); [exact f | apply Rmax_lub; assumption].
Qed.

Lemma above0_is_true i x : above0 i = true -> is_in x i -> 0 < x.
Proof.
  unfold above0, is_in; intros a b.
  assert (h := I.sign_strict_correct i). destruct (I.sign_strict i); try discriminate.
  destruct (h _ b) as [_ c]; exact c.
Qed.

Section Precision.

Variable prec : F.precision.

Lemma add_is_in x y i j : is_in x i -> is_in y j -> is_in (x + y) (add prec i j).
Proof. exact (I.add_correct prec i j (Xreal x) (Xreal y)). Qed.

Lemma sub_is_in x y i j : is_in x i -> is_in y j -> is_in (x - y) (sub prec i j).
Proof. exact (I.sub_correct prec i j (Xreal x) (Xreal y)). Qed.

Lemma mul_is_in x y i j : is_in x i -> is_in y j -> is_in (x * y) (mul prec i j).
Proof. exact (I.mul_correct prec i j (Xreal x) (Xreal y)). Qed.

Lemma neg_is_in x i : is_in x i -> is_in (- x) (I.neg i).
Proof. exact (I.neg_correct i (Xreal x)). Qed.

(** Also where y is 0, since nothing is known then. *)
Lemma div_is_in x y i j : is_in x i -> is_in y j -> is_in (x / y) (div prec i j).
Proof.
  intros a b. assert (h := I.div_correct prec i j (Xreal x) (Xreal y) a b).
  simpl in h; unfold Xdiv' in h. destruct (is_zero y); [now apply nothing_is_known | exact h].
Qed.

Lemma div_by_0_is_in x i j : (exists y, is_in y i) -> is_in 0 j -> is_in x (div prec i j).
Proof.
  intros [y a] b. assert (h := I.div_correct prec i j (Xreal y) (Xreal 0) a b).
  simpl in h; unfold Xdiv' in h; rewrite is_zero_0 in h. now apply nothing_is_known.
Qed.

Lemma sqrt_is_in x i : is_in x i -> is_in (sqrt x) (I.sqrt prec i).
Proof.
  intros a. assert (h := I.sqrt_correct prec i (Xreal x) a).
  simpl in h; unfold Xsqrt' in h. exact h.
Qed.

Lemma sin_is_in x i : is_in x i -> is_in (sin x) (I.sin prec i).
Proof. exact (I.sin_correct prec i (Xreal x)). Qed.

Lemma cos_is_in x i : is_in x i -> is_in (cos x) (I.cos prec i).
Proof. exact (I.cos_correct prec i (Xreal x)). Qed.

Lemma atan_is_in x i : is_in x i -> is_in (atan x) (I.atan prec i).
Proof. exact (I.atan_correct prec i (Xreal x)). Qed.

Lemma integer_is_in z : is_in (IZR z) (integer prec z).
Proof. exact (I.fromZ_correct prec z). Qed.

Lemma fraction_is_in (q : Q) : is_in (Q2R q) (fraction prec q).
Proof. unfold fraction, Q2R. apply div_is_in; apply integer_is_in. Qed.

Lemma apart0_is_true i x : apart0 i = true -> is_in x i -> x <> 0.
Proof.
  unfold apart0, is_in; intros a b.
  assert (h := I.sign_strict_correct i). destruct (I.sign_strict i); try discriminate;
    destruct (h _ b) as [_ c]; cbn in c; lra.
Qed.

Lemma nai_has_all x : is_in x I.nai.
Proof. apply nothing_is_known. rewrite I.nai_correct. exact I. Qed.

(** ** Slopes in balls *)

Lemma nth_repeat_below {A : Type} (x y : A) n i : (i < n)%nat -> nth i (repeat x n) y = x.
Proof. revert i. induction n as [| n IH]; intros i l; [lia |]. destruct i; cbn; [reflexivity | apply IH; lia]. Qed.

Definition v_is_in (g : vec R) (v : vec interval) : Prop := is_in (vx g) (vx v) /\ is_in (vy g) (vy v) /\
  is_in (vz g) (vz v).
Definition in_block (g : vec R) (u : block) : Prop := match u with None => g = Vec 0 0 0 | Some v => v_is_in g v end.
Definition in_blocks (g : nat -> vec R) (l : list block) : Prop := forall b, (b < balls)%nat ->
  in_block (g b) (nth b l None).

Lemma nth_b_add k l b : nth b (b_add prec k l) None = b_plus prec (nth b k None) (nth b l None).
Proof.
  revert l b. induction k as [| u k IH]; intros l b.
  - destruct b; destruct l; reflexivity.
  - destruct l as [| v l].
    + destruct b; cbn; [now destruct u | now destruct (nth b k None)].
    + destruct b; cbn; [reflexivity | apply IH].
Qed.

Lemma zero_plus g : plus (Vec 0 0 0) g = g.
Proof. destruct g. unfold plus. cbn. f_equal; ring. Qed.

Lemma plus_zero g : plus g (Vec 0 0 0) = g.
Proof. destruct g. unfold plus. cbn. f_equal; ring. Qed.

Lemma b_add_holds g h k l : in_blocks g k -> in_blocks h l -> in_blocks (fun b => plus (g b) (h b)) (b_add prec k l).
Proof.
  intros a b n lt. rewrite nth_b_add. generalize (a n lt), (b n lt).
  destruct (nth n k None) as [u |], (nth n l None) as [v |]; cbn [in_block b_plus]; intros x y.
  - destruct x as [x1 [x2 x3]], y as [y1 [y2 y3]].
    exact (conj (add_is_in _ _ _ _ x1 y1) (conj (add_is_in _ _ _ _ x2 y2) (add_is_in _ _ _ _ x3 y3))).
  - rewrite y, plus_zero. exact x.
  - rewrite x, zero_plus. exact y.
  - rewrite x, y. apply plus_zero.
Qed.

Lemma b_map_holds (c : R) (f : interval -> interval) g l : (forall x i, is_in x i -> is_in (c * x) (f i)) ->
  in_blocks g l -> in_blocks (fun b => times c (g b)) (b_map f l).
Proof.
  intros hf a n lt. assert (e : nth n (b_map f l) None = option_map (v_map f) (nth n l None))
    by exact (map_nth (option_map (v_map f)) l None n).
  change (in_block (times c (g n)) (nth n (b_map f l) None)). rewrite e. generalize (a n lt).
  destruct (nth n l None) as [u |]; cbn [in_block option_map]; intros x.
  - destruct x as [x1 [x2 x3]]. exact (conj (hf _ _ x1) (conj (hf _ _ x2) (hf _ _ x3))).
  - rewrite x. unfold times. cbn. f_equal; ring.
Qed.

Lemma no_blocks : in_blocks (fun _ => Vec 0 0 0) [].
Proof. intros b _. destruct b; reflexivity. Qed.

Lemma b_only_holds ball g v : v_is_in g v -> in_blocks (fun b =>
  if Nat.eqb b ball then g else Vec 0 0 0) (b_only ball v).
Proof.
  intros h b _. unfold b_only. destruct (Nat.eqb_spec b ball) as [-> | n].
  - rewrite app_nth2 by (rewrite repeat_length; lia). rewrite repeat_length, Nat.sub_diag. exact h.
  - destruct (Nat.lt_ge_cases b ball) as [l | g'].
    + rewrite app_nth1 by (rewrite repeat_length; exact l). rewrite nth_repeat. reflexivity.
    + rewrite nth_overflow; [reflexivity |]. rewrite app_length, repeat_length. cbn. lia.
Qed.

(** ** Forms *)

Definition in_slopes (k : change) (f : form) : Prop := is_in (of_place k) (slope f) /\ in_blocks (of_ball k) (slopes f).

Section Offset.

Variable t : change.

(** [q] is a quantity's value at m, and [q'] its value at s of a machine that deviates. *)
Definition encloses (f : form) (q q' : R) : Prop :=
  is_in q (mid f) /\ is_in q (over f) /\ is_in q' (over f) /\ exists k, in_slopes k f /\ sloped k t q q'.

Lemma does_not_change f q q' : encloses f q q' -> is_still t -> q' = q.
Proof. intros [_ [_ [_ [k [_ h]]]]] z. rewrite h, (moved_still k t z). ring. Qed.

Lemma nothing_encloses q q' : (is_still t -> q' = q) -> encloses nothing q q'.
Proof.
  intros h. destruct (has_slope t q q' h) as [k e].
  split; [apply nai_has_all | split; [apply nai_has_all | split; [apply nai_has_all |]]].
  exists k. split; [| exact e]. split; [apply nai_has_all |]. intros b l. cbn [slopes nothing].
  rewrite nth_repeat_below by exact l. split; [| split]; apply nai_has_all.
Qed.

Lemma scaled_is_in c x i j : is_in x i -> is_in c j -> is_in (c * x) (mul prec i j).
Proof. rewrite Rmult_comm. apply mul_is_in. Qed.

Lemma opposite_is_in x i : is_in x i -> is_in (- 1 * x) (I.neg i).
Proof. replace (- 1 * x) with (- x) by ring. apply neg_is_in. Qed.

Lemma constant_encloses x i : is_in x i -> encloses (constant prec i) x x.
Proof.
  intros a; split; [exact a | split; [exact a | split; [exact a |]]]. exists (k_place 0). split.
  - split; [apply (integer_is_in 0) | apply no_blocks].
  - unfold sloped. rewrite moved_place. ring.
Qed.

Lemma neg_encloses f q q' : encloses f q q' -> encloses (f_neg f) (- q) (- q').
Proof.
  intros [a [b [c [k [[d g] e]]]]]; split; [| split; [| split]]; try (apply neg_is_in; assumption).
  exists (k_times (- 1) k). split; [split; [now apply opposite_is_in |] | now apply sloped_minus].
  apply b_map_holds; [exact opposite_is_in | exact g].
Qed.

Lemma add_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_add prec f g) (q + r) (q' + r').
Proof.
  intros [a [b [c [k [[d g1] e]]]]] [a' [b' [c' [l [[d' g2] e']]]]]; split; [| split; [| split]];
    try (apply add_is_in; assumption).
  exists (k_plus k l). split; [split; [now apply add_is_in | now apply b_add_holds] | now apply sloped_plus].
Qed.

Lemma sub_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_sub prec f g) (q - r) (q' - r').
Proof.
  intros [a [b [c [k [[d g1] e]]]]] [a' [b' [c' [l [[d' g2] e']]]]]; split; [| split; [| split]];
    try (apply sub_is_in; assumption).
  exists (k_plus k (k_times (- 1) l)). split; [split |].
  - cbn [of_place k_plus k_times]. replace (_ + _) with (of_place k - of_place l) by ring. now apply sub_is_in.
  - apply b_add_holds; [exact g1 |]. apply b_map_holds; [exact opposite_is_in | exact g2].
  - unfold Rminus. apply sloped_plus; [exact e | now apply sloped_minus].
Qed.

Lemma mul_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_mul prec f g) (q * r) (q' * r').
Proof.
  intros [a [b [c [k [[d g1] e]]]]] [a' [b' [c' [l [[d' g2] e']]]]]; split; [| split; [| split]];
    try (apply mul_is_in; assumption).
  exists (k_plus (k_times r' k) (k_times q l)). split; [split | now apply sloped_times].
  - cbn [of_place k_plus k_times]. apply add_is_in; [now apply scaled_is_in | now apply mul_is_in].
  - apply b_add_holds; apply b_map_holds; try assumption; intros x i h; now apply scaled_is_in.
Qed.

Lemma div_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_div prec f g) (q / r) (q' / r').
Proof.
  intros hf hg. unfold f_div.
  destruct (apart0 (mid g)) eqn:n; [destruct (apart0 (over g)) eqn:n'|]; cbn [andb];
    try (apply nothing_encloses; intros z; now rewrite (does_not_change _ _ _ hf z), (does_not_change _ _ _ hg z)).
  destruct hf as [a [b [c [k [[d g1] e]]]]]. destruct hg as [a' [b' [c' [l [[d' g2] e']]]]].
  assert (z := apart0_is_true _ _ n a'). assert (z' := apart0_is_true _ _ n' c').
  split; [| split; [| split]]; try (apply div_is_in; assumption).
  exists (k_times (/ r') (k_plus k (k_times (- 1) (k_times (q / r) l)))).
  assert (by_r : forall x i, is_in x i -> is_in (/ r' * x) (div prec i (over g))).
  { intros x i h. replace (/ r' * x) with (x / r') by (unfold Rdiv; ring). now apply div_is_in. }
  split; [split | now apply sloped_over].
  - apply by_r. cbn [of_place k_plus k_times]. replace (_ + _) with (of_place k - q / r * of_place l) by ring.
    apply sub_is_in; [exact d |]. apply mul_is_in; [now apply div_is_in | exact d'].
  - apply b_map_holds; [exact by_r |]. apply b_add_holds; [exact g1 |].
    apply b_map_holds; [exact opposite_is_in |]. apply b_map_holds; [| exact g2].
    intros x i h. apply scaled_is_in; [exact h | now apply div_is_in].
Qed.

Lemma sqrt_encloses f q q' : encloses f q q' -> encloses (f_sqrt prec f) (sqrt q) (sqrt q').
Proof.
  intros hf. unfold f_sqrt.
  destruct (above0 (mid f)) eqn:p; [destruct (above0 (over f)) eqn:p'|]; cbn [andb];
    try (apply nothing_encloses; intros z; now rewrite (does_not_change _ _ _ hf z)).
  destruct hf as [a [b [c [k [[d g] e]]]]].
  assert (x := above0_is_true _ _ p a). assert (x' := above0_is_true _ _ p' c).
  split; [| split; [| split]]; try (apply sqrt_is_in; assumption).
  exists (k_times (/ (sqrt q + sqrt q')) k).
  assert (by_roots : forall x i, is_in x i ->
      is_in (/ (sqrt q + sqrt q') * x) (div prec i (add prec (I.sqrt prec (mid f)) (I.sqrt prec (over f))))).
  { intros y i h. replace (_ * y) with (y / (sqrt q + sqrt q')) by (unfold Rdiv; ring).
    apply div_is_in; [exact h | apply add_is_in; now apply sqrt_is_in]. }
  split; [split; [now apply by_roots | now apply b_map_holds] |].
  apply sloped_sqrt; [lra | exact x' | exact e].
Qed.

Lemma sin_encloses f q q' : encloses f q q' -> encloses (f_sin prec f) (sin q) (sin q').
Proof.
  intros [a [b [c [k [[d g] e]]]]]; split; [| split; [| split]]; try (apply sin_is_in; assumption).
  destruct (sloped_sin k t q q' e) as [x [x_between h]].
  assert (hc : is_in (cos x) (I.cos prec (over f))) by (apply cos_is_in; exact (between_is_in _ _ _ _ b c x_between)).
  exists (k_times (cos x) k); split; [split | exact h].
  - now apply mul_is_in.
  - apply b_map_holds; [| exact g]. intros y i l. now apply scaled_is_in.
Qed.

Lemma cos_encloses f q q' : encloses f q q' -> encloses (f_cos prec f) (cos q) (cos q').
Proof.
  intros [a [b [c [k [[d g] e]]]]]; split; [| split; [| split]]; try (apply cos_is_in; assumption).
  destruct (sloped_cos k t q q' e) as [x [x_between h]].
  assert (hs : is_in (- sin x) (I.neg (I.sin prec (over f)))).
  { apply neg_is_in, sin_is_in. exact (between_is_in _ _ _ _ b c x_between). }
  exists (k_times (- sin x) k); split; [split | exact h].
  - now apply mul_is_in.
  - apply b_map_holds; [| exact g]. intros y i l. now apply scaled_is_in.
Qed.

Lemma join_left x i j : is_in x i -> is_in x (I.join i j).
Proof. intros h. apply I.join_correct. now left. Qed.

Lemma join_right x i j : is_in x j -> is_in x (I.join i j).
Proof. intros h. apply I.join_correct. now right. Qed.

Lemma symmetric_is_in b y i : is_in b i -> Rabs y <= b -> is_in y (symmetric i).
Proof.
  intros h a. unfold symmetric.
  apply (between_is_in (- b) b); [now apply join_left, neg_is_in | now apply join_right |].
  assert (n : 0 <= b) by (apply Rle_trans with (Rabs y); [apply Rabs_pos | exact a]).
  rewrite Rmin_left, Rmax_right by lra. unfold Rabs in a. destruct (Rcase_abs y); lra.
Qed.

Lemma sqr_is_in x i : is_in x i -> is_in (x * x) (I.sqr prec i).
Proof. intros h. exact (I.sqr_correct prec i (Xreal x) h). Qed.

Lemma norm_of_is_in u v : v_is_in u v -> is_in (norm u) (norm_of prec v).
Proof. intros [a [b c]]. unfold norm, dot. apply sqrt_is_in. repeat apply add_is_in; now apply sqr_is_in. Qed.

(** How far a machine may deviate: no further than radii in some intervals, as many as there are balls. *)
Definition deviates_within (e : nat -> vec R) (n : nat) (radii : list interval) : Prop :=
  forall b, (b < n)%nat -> exists r, norm (e b) <= r /\ is_in r (nth b radii I.nai).

Lemma change_is_in radii l g e : deviates_within e (List.length radii) radii ->
  (forall b, (b < List.length radii)%nat -> in_block (g b) (nth b l None)) ->
  is_in (sum_over (List.length radii) (fun b => dot (g b) (e b))) (b_change prec radii l).
Proof.
  revert l g e. induction radii as [| r radii IH]; intros l g e he hg.
  - destruct l as [| [v |] l]; [apply (integer_is_in 0) | apply nai_has_all | apply nai_has_all].
  - destruct l as [| u l].
    + rewrite (sum_over_same _ _ (fun _ => 0)), sum_over_zeros; [apply (integer_is_in 0) |].
      intros b lt. assert (h := hg b lt). destruct b; cbn in h; rewrite h; apply dot_zero_left.
    + assert (rest : is_in (sum_over (List.length radii) (fun b => dot (g (S b)) (e (S b)))) (b_change prec radii l)).
      { apply (IH l (fun b => g (S b)) (fun b => e (S b))).
        - intros b lt. apply (he (S b)). cbn. lia.
        - intros b lt. apply (hg (S b)). cbn. lia. }
      cbn [List.length sum_over]. assert (h := hg 0%nat ltac:(cbn; lia)). cbn in h.
      destruct u as [v |]; cbn [b_change].
      * apply add_is_in; [| exact rest]. destruct (he 0%nat ltac:(cbn; lia)) as [rho [small hr]]. cbn in hr.
        apply (symmetric_is_in (rho * norm (g 0%nat))); [apply mul_is_in; [exact hr | now apply norm_of_is_in] |].
        apply Rle_trans with (1 := dot_is_below _ _). rewrite Rmult_comm.
        apply Rmult_le_compat_r; [apply norm_is_positive | exact small].
      * rewrite h, dot_zero_left. now rewrite Rplus_0_l.
Qed.

(** What m and s lead to is in the same form, narrowed by its slopes. *)
Lemma tight_encloses reach f q q' : is_in 0 (fst reach) -> is_in (of_place t) (fst reach) ->
  List.length (snd reach) = balls ->
  deviates_within (of_ball t) balls (snd reach) -> encloses f q q' -> encloses (tight prec reach f) q q'.
Proof.
  intros z o n he [a [b [c [k [[d g] e]]]]]. rewrite <- n in he.
  assert (within : forall u, u = 0 \/ u = 1 -> is_in (q + (of_place k * (u * of_place t) +
      sum_over balls (fun b => dot (of_ball k b) (times u (of_ball t b)))))
      (add prec (mid f) (add prec (mul prec (slope f) (fst reach)) (b_change prec (snd reach) (slopes f))))).
  { intros u hu. apply add_is_in; [exact a |]. apply add_is_in.
    - apply mul_is_in; [exact d |]. destruct hu as [-> | ->]; [now rewrite Rmult_0_l | now rewrite Rmult_1_l].
    - rewrite <- n. apply change_is_in; [| now rewrite n].
      intros b0 l. destruct (he b0 l) as [r [small hr]]. exists r. split; [| exact hr].
      rewrite norm_of_times. destruct hu as [-> | ->]; [| now rewrite Rabs_R1, Rmult_1_l].
      rewrite Rabs_R0, Rmult_0_l. apply Rle_trans with (2 := small). apply norm_is_positive. }
  assert (at_m : is_in q (add prec (mid f) (add prec (mul prec (slope f) (fst reach)) (b_change prec (snd reach)
    (slopes f))))).
  { assert (h := within 0 (or_introl eq_refl)). rewrite (sum_over_same _ _ (fun _ => 0)), sum_over_zeros in h.
    - replace q with (q + (of_place k * (0 * of_place t) + 0)) by ring. exact h.
    - intros b0 _. destruct (of_ball k b0), (of_ball t b0). unfold dot, times. cbn. ring. }
  assert (at_s : is_in q' (add prec (mid f) (add prec (mul prec (slope f) (fst reach)) (b_change prec (snd reach)
    (slopes f))))).
  { assert (h := within 1 (or_intror eq_refl)). rewrite (sum_over_same _ _ (fun b =>
    dot (of_ball k b) (of_ball t b))) in h.
    - rewrite e. unfold moved. rewrite Rmult_1_l in h. exact h.
    - intros b0 _. destruct (of_ball k b0), (of_ball t b0). unfold dot, times. cbn. ring. }
  split; [exact a | split; [apply I.meet_correct; assumption | split; [apply I.meet_correct; assumption |]]].
  exists k. split; [split; assumption | exact e].
Qed.

(** The value of every expression of parameters that their forms enclose. *)
Theorem eval_encloses (p : nat -> form) (v v' : nat -> R) : (forall i, encloses (p i) (v i) (v' i)) ->
  forall e, encloses (eval prec p e) (value v e) (value v' e).
Proof.
  intros h e; induction e; simpl.
  - apply constant_encloses, fraction_is_in.
  - apply constant_encloses, I.pi_correct.
  - apply h.
  - now apply neg_encloses.
  - now apply add_encloses.
  - now apply sub_encloses.
  - now apply mul_encloses.
  - now apply div_encloses.
  - now apply sqrt_encloses.
  - now apply sin_encloses.
  - now apply cos_encloses.
Qed.

End Offset.
End Precision.
End Enclosure.
