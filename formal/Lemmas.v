(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Lemmas over the real numbers, on which a proof of soundness can rest *)

From Coq Require Import Reals List Lra Psatz.
From Coquelicot Require Import Coquelicot.
Open Scope R_scope.

(** ** Slopes: q(s) = q(m) + k (s - m). Below, [f] is f(m) and [f'] is f(s); the same for [g], and t = s - m. *)

Definition sloped (k t f f' : R) : Prop := f' = f + k * t.

Lemma sloped_plus k l t f f' g g' : sloped k t f f' -> sloped l t g g' -> sloped (k + l) t (f + g) (f' + g').
Proof. unfold sloped; intros -> ->; ring. Qed.

Lemma sloped_sub k l t f f' g g' : sloped k t f f' -> sloped l t g g' -> sloped (k - l) t (f - g) (f' - g').
Proof. unfold sloped; intros -> ->; ring. Qed.

Lemma sloped_times k l t f f' g g' :
  sloped k t f f' -> sloped l t g g' -> sloped (k * g' + f * l) t (f * g) (f' * g').
Proof. unfold sloped; intros -> ->; ring. Qed.

Lemma sloped_over k l t f f' g g' : g <> 0 -> g' <> 0 ->
  sloped k t f f' -> sloped l t g g' -> sloped ((k - f / g * l) / g') t (f / g) (f' / g').
Proof. unfold sloped; intros a b -> H; rewrite H in *; field; auto. Qed.

Lemma sloped_sqrt k t f f' : 0 <= f -> 0 < f' ->
  sloped k t f f' -> sloped (k / (sqrt f + sqrt f')) t (sqrt f) (sqrt f').
Proof.
  unfold sloped; intros a b H.
  assert (p := sqrt_pos f). assert (q := sqrt_lt_R0 f' b).
  assert (r := sqrt_sqrt f a). assert (s := sqrt_sqrt f' (Rlt_le _ _ b)).
  apply Rmult_eq_reg_r with (sqrt f + sqrt f'); [|lra].
  replace ((sqrt f + k / (sqrt f + sqrt f') * t) * (sqrt f + sqrt f'))
    with (sqrt f * (sqrt f + sqrt f') + k * t) by (field; lra).
  replace (k * t) with (f' - f) by lra. nra.
Qed.

Lemma sloped_sin k t f f' : sloped k t f f' ->
  exists x, Rmin f f' <= x <= Rmax f f' /\ sloped (cos x * k) t (sin f) (sin f').
Proof.
  unfold sloped; intros H.
  destruct (MVT_gen sin f f' cos) as [x [r e]].
  - intros x _; auto_derive; [exact I | ring].
  - intros x _; apply continuity_sin.
  - exists x; split; [exact r|]. replace (cos x * k * t) with (cos x * (f' - f)) by (rewrite H; ring). lra.
Qed.

Lemma sloped_cos k t f f' : sloped k t f f' ->
  exists x, Rmin f f' <= x <= Rmax f f' /\ sloped (- sin x * k) t (cos f) (cos f').
Proof.
  unfold sloped; intros H.
  destruct (MVT_gen cos f f' (fun x => - sin x)) as [x [r e]].
  - intros x _; auto_derive; [exact I | ring].
  - intros x _; apply continuity_cos.
  - exists x; split; [exact r|]. replace (- sin x * k * t) with (- sin x * (f' - f)) by (rewrite H; ring). lra.
Qed.

(** ** The range of a linear function over an ellipsoid whose matrix is diagonal: Cauchy and Schwarz.
    A term is (c, e, z): a coefficient, the matrix's entry, and a coordinate. *)

Definition total (f : R * R * R -> R) (l : list (R * R * R)) : R := fold_right (fun a s => f a + s) 0 l.
Definition linear : list (R * R * R) -> R := total (fun '(c, _, z) => c * z).
Definition spread : list (R * R * R) -> R := total (fun '(c, e, _) => c * c / e).
Definition form : list (R * R * R) -> R := total (fun '(_, e, z) => e * (z * z)).

Definition positive (l : list (R * R * R)) : Prop := List.Forall (fun a => 0 < snd (fst a)) l.

Lemma cauchy_schwarz l : positive l ->
  0 <= spread l /\ 0 <= form l /\ linear l * linear l <= spread l * form l.
Proof.
  induction 1 as [| [[c e] z] l p _ [a [b h]]]; cbn [fst snd] in *; unfold linear, spread, form, total in *;
    cbn [fold_right] in *; [lra|].
  set (S := fold_right (fun a s => (let '(c, _, z) := a in c * z) + s) 0 l) in *.
  set (A := fold_right (fun a s => (let '(c, e, _) := a in c * c / e) + s) 0 l) in *.
  set (B := fold_right (fun a s => (let '(_, e, z) := a in e * (z * z)) + s) 0 l) in *.
  assert (u : 0 <= c * c / e) by (apply Rmult_le_pos; [nra | left; now apply Rinv_0_lt_compat]).
  assert (v : 0 <= e * (z * z)) by nra.
  split; [lra|]. split; [lra|].
  set (X := A * (e * (z * z))). set (Y := B * (c * c / e)).
  assert (x : 0 <= X) by (apply Rmult_le_pos; lra). assert (y : 0 <= Y) by (apply Rmult_le_pos; lra).
  assert (xy : X * Y = A * B * ((c * z) * (c * z))) by (unfold X, Y; field; lra).
  assert (w : S * S * ((c * z) * (c * z)) <= X * Y)
    by (rewrite xy; apply Rmult_le_compat_r; [nra | exact h]).
  assert (k : 2 * S * (c * z) <= X + Y).
  { apply Rnot_lt_le; intro n. assert (0 <= (X - Y) * (X - Y)) by apply Rle_0_sqr.
    assert ((X + Y) * (X + Y) < (2 * S * (c * z)) * (2 * S * (c * z))) by (apply Rmult_le_0_lt_compat; lra). nra. }
  replace ((c * c / e + A) * (e * (z * z) + B)) with (c * c * (z * z) + X + Y + A * B)
    by (unfold X, Y; field; lra).
  nra.
Qed.

Theorem range_of_ellipsoid l : positive l -> form l <= 1 ->
  Rabs (linear l) <= sqrt (spread l).
Proof.
  intros p q; destruct (cauchy_schwarz l p) as [a [b h]].
  rewrite <- sqrt_Rsqr_abs; apply sqrt_le_1_alt; unfold Rsqr; nra.
Qed.

(** ** Boxes from [begin] to their last end hold every point between. *)

Fixpoint last_end (begin : R) (ends : list R) : R := match ends with nil => begin | e :: l => last_end e l end.
Fixpoint hold (P : R -> Prop) (begin : R) (ends : list R) : Prop :=
  match ends with nil => True | e :: l => (forall s, begin <= s <= e -> P s) /\ hold P e l end.

Theorem boxes_cover P ends : forall begin, ends <> nil -> hold P begin ends ->
  forall s, begin <= s <= last_end begin ends -> P s.
Proof.
  induction ends as [| e l IH]; [easy|]; intros begin _ [h k] s [a b]; cbn in b.
  destruct (Rle_dec s e) as [c | c]; [apply h; lra|].
  destruct l as [| d l]; [cbn in b; lra|]. apply (IH e); [easy | exact k | lra].
Qed.

Print Assumptions range_of_ellipsoid.
