(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker computes of expressions encloses their values and slopes *)

From Coq Require Import Reals QArith Qreals ZArith Lra Bool.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Checker.
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

Lemma integer_is_in z : is_in (IZR z) (integer prec z).
Proof. exact (I.fromZ_correct prec z). Qed.

Lemma fraction_is_in (q : Q) : is_in (Q2R q) (fraction prec q).
Proof. unfold fraction, Q2R. apply div_is_in; apply integer_is_in. Qed.

(** ** Forms *)

Section Offset.

Variable t : R.

(** [q] is a quantity's value at m, and [q'] its value at s = m + t. *)
Definition encloses (f : form) (q q' : R) : Prop :=
  is_in q (mid f) /\ is_in q (over f) /\ is_in q' (over f) /\ exists k, is_in k (slope f) /\ sloped k t q q'.

(** A slope there always is, but where the quantity changes and t is 0. *)
Lemma has_slope q q' : (t = 0 -> q' = q) -> exists k, sloped k t q q'.
Proof.
  unfold sloped; intros h. destruct (Req_dec t 0) as [z | n].
  - exists 0. rewrite (h z). ring.
  - exists ((q' - q) / t). now field.
Qed.

Lemma does_not_change f q q' : encloses f q q' -> t = 0 -> q' = q.
Proof. intros [_ [_ [_ [k [_ h]]]]] z. rewrite h, z. ring. Qed.

Lemma constant_encloses x i : is_in x i -> encloses (constant prec i) x x.
Proof.
  intros a; repeat split; try exact a. exists 0; split; [apply (integer_is_in 0) | unfold sloped; ring].
Qed.

Lemma neg_encloses f q q' : encloses f q q' -> encloses (f_neg f) (- q) (- q').
Proof.
  intros [a [b [c [k [d e]]]]]; repeat split; try (apply neg_is_in; assumption).
  exists (- k); split; [now apply neg_is_in | unfold sloped in *; rewrite e; ring].
Qed.

Lemma add_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_add prec f g) (q + r) (q' + r').
Proof.
  intros [a [b [c [k [d e]]]]] [a' [b' [c' [l [d' e']]]]]; repeat split; try (apply add_is_in; assumption).
  exists (k + l); split; [now apply add_is_in | now apply sloped_plus].
Qed.

Lemma sub_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_sub prec f g) (q - r) (q' - r').
Proof.
  intros [a [b [c [k [d e]]]]] [a' [b' [c' [l [d' e']]]]]; repeat split; try (apply sub_is_in; assumption).
  exists (k - l); split; [now apply sub_is_in | now apply sloped_sub].
Qed.

Lemma mul_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_mul prec f g) (q * r) (q' * r').
Proof.
  intros [a [b [c [k [d e]]]]] [a' [b' [c' [l [d' e']]]]]; repeat split; try (apply mul_is_in; assumption).
  exists (k * r' + q * l); split; [| now apply sloped_times].
  apply add_is_in; now apply mul_is_in.
Qed.

Lemma div_encloses f g q q' r r' : encloses f q q' -> encloses g r r' -> encloses (f_div prec f g) (q / r) (q' / r').
Proof.
  intros hf hg. assert (hf' := hf). assert (hg' := hg).
  destruct hf as [a [b [c [k [d e]]]]]. destruct hg as [a' [b' [c' [l [d' e']]]]].
  repeat split; try (apply div_is_in; assumption).
  assert (n : is_in (k - q / r * l) (sub prec (slope f) (mul prec (div prec (mid f) (mid g)) (slope g)))).
  { apply sub_is_in; [exact d |]. apply mul_is_in; [now apply div_is_in | exact d']. }
  assert (h : exists j, sloped j t (q / r) (q' / r')).
  { apply has_slope; intros z. now rewrite (does_not_change _ _ _ hf' z), (does_not_change _ _ _ hg' z). }
  destruct (Req_dec r 0) as [z | z].
  - destruct h as [j h]; exists j; split; [| exact h].
    apply div_by_0_is_in; [eexists; exact n | rewrite <- z; exact b'].
  - destruct (Req_dec r' 0) as [z' | z'].
    + destruct h as [j h]; exists j; split; [| exact h].
      apply div_by_0_is_in; [eexists; exact n | rewrite <- z'; exact c'].
    + exists ((k - q / r * l) / r'); split; [now apply div_is_in | now apply sloped_over].
Qed.

Lemma sqrt_encloses f q q' : encloses f q q' -> encloses (f_sqrt prec f) (sqrt q) (sqrt q').
Proof.
  intros hf. assert (hf' := hf). destruct hf as [a [b [c [k [d e]]]]]. unfold f_sqrt.
  destruct (above0 (mid f)) eqn:p; [destruct (above0 (over f)) eqn:p'|]; simpl.
  - assert (x := above0_is_true _ _ p a). assert (x' := above0_is_true _ _ p' c).
    repeat split; try (apply sqrt_is_in; assumption).
    exists (k / (sqrt q + sqrt q')); split.
    + apply div_is_in; [exact d | apply add_is_in; now apply sqrt_is_in].
    + apply sloped_sqrt; [lra | exact x' | exact e].
  - destruct (has_slope (sqrt q) (sqrt q')) as [j h];
      [intros z; now rewrite (does_not_change _ _ _ hf' z) | repeat split; now exists j].
  - destruct (has_slope (sqrt q) (sqrt q')) as [j h];
      [intros z; now rewrite (does_not_change _ _ _ hf' z) | repeat split; now exists j].
Qed.

Lemma sin_encloses f q q' : encloses f q q' -> encloses (f_sin prec f) (sin q) (sin q').
Proof.
  intros [a [b [c [k [d e]]]]]; repeat split; try (apply sin_is_in; assumption).
  destruct (sloped_sin k t q q' e) as [x [x_between h]].
  exists (cos x * k); split; [| exact h].
  apply mul_is_in; [apply cos_is_in; exact (between_is_in _ _ _ _ b c x_between) | exact d].
Qed.

Lemma cos_encloses f q q' : encloses f q q' -> encloses (f_cos prec f) (cos q) (cos q').
Proof.
  intros [a [b [c [k [d e]]]]]; repeat split; try (apply cos_is_in; assumption).
  destruct (sloped_cos k t q q' e) as [x [x_between h]].
  exists (- sin x * k); split; [| exact h].
  replace (- sin x * k) with (- (sin x * k)) by ring. apply neg_is_in.
  apply mul_is_in; [apply sin_is_in; exact (between_is_in _ _ _ _ b c x_between) | exact d].
Qed.

(** What m and s lead to is in the same form, narrowed by its slope. *)
Lemma tight_encloses offset f q q' : is_in 0 offset -> is_in t offset -> encloses f q q' ->
  encloses (tight prec offset f) q q'.
Proof.
  intros z o [a [b [c [k [d e]]]]].
  assert (at_m : is_in q (add prec (mid f) (mul prec (slope f) offset))).
  { replace q with (q + k * 0) by ring. apply add_is_in; [exact a | now apply mul_is_in]. }
  assert (at_s : is_in q' (add prec (mid f) (mul prec (slope f) offset))).
  { rewrite e. apply add_is_in; [exact a | now apply mul_is_in]. }
  repeat split; try exact a; try (apply I.meet_correct; assumption). now exists k.
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
