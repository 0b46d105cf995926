(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Neumann's bound for six equations over Coq's real numbers *)

From Coq Require Import Reals.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.analysis Require Import Rstruct.
From Taut Require Import Neumann.
Import GRing.Theory Num.Theory Order.Theory.

Local Open Scope R_scope.

Definition total (f : nat -> R) : R := f 0%N + f 1%N + f 2%N + f 3%N + f 4%N + f 5%N.
Definition delta (i j : nat) : R := if Nat.eqb i j then 1 else 0.
(** A x, and I - C A. *)
Definition apply6 (A : nat -> nat -> R) (x : nat -> R) (i : nat) : R := total (fun j => A i j * x j).
Definition error6 (C A : nat -> nat -> R) (i j : nat) : R := delta i j - total (fun k => C i k * A k j).

Local Notation vector := 'cV[R]_6.
Local Notation matrix := 'M[R]_6.
Definition to_vector (x : nat -> R) : vector := (\col_i x i)%R.
Definition to_matrix (A : nat -> nat -> R) : matrix := (\matrix_(i, j) A i j)%R.
Definition from_vector (x : vector) (i : nat) : R := x (inord i) ord0.

Lemma totalE (f : nat -> R) : (\sum_(j < 6) f j)%R = total f.
Proof. by rewrite !big_ord_recr big_ord0 /= add0r. Qed.

Lemma apply6E A x i : (to_matrix A *m to_vector x)%R i ord0 = apply6 A x i.
Proof. by rewrite mxE /apply6 -totalE; apply: eq_bigr => j _; rewrite !mxE. Qed.

Lemma error6E C A (i j : 'I_6) : (1%:M - to_matrix C *m to_matrix A)%R i j = error6 C A i j.
Proof.
rewrite !mxE /error6 -totalE RminusE /delta; congr (_ - _)%R; last by apply: eq_bigr => k _; rewrite !mxE.
rewrite -val_eqE /=; case: (Nat.eqb_spec i j) => [-> | h]; first by rewrite eqxx.
by case: eqP.
Qed.

Lemma from_vectorK x : to_vector (from_vector x) = x.
Proof. by apply/matrixP => i j; rewrite !mxE /from_vector inord_val (ord1 j). Qed.

Theorem solved6 (A C : nat -> nat -> R) (rho : R) :
  (forall i, (i < 6)%N -> total (fun j => Rabs (error6 C A i j)) <= rho) -> rho < 1 ->
  forall (w x0 : nat -> R) (M : R),
  (forall i, (i < 6)%N -> Rabs (total (fun k => C i k * (w k - apply6 A x0 k))) <= M) ->
  exists x, (forall i, (i < 6)%N -> apply6 A x i = w i) /\
    (forall z, (forall i, (i < 6)%N -> apply6 A z i = w i) -> forall i, (i < 6)%N -> z i = x i) /\
    (forall i, (i < 6)%N -> Rabs (x i - x0 i) * (1 - rho) <= M) /\
    (forall i, (i < 6)%N -> x i - x0 i = total (fun k => C i k * (w k - apply6 A x0 k)) +
                                         total (fun j => error6 C A i j * (x j - x0 j))).
Proof.
move=> rows small w x0 M b.
have rows' (i : 'I_6) : (\sum_j `|(1%:M - to_matrix C *m to_matrix A) i j| <= rho)%R.
  apply/RleP; rewrite (_ : (\sum_j _)%R = total (fun j => Rabs (error6 C A i j))); first exact: rows.
  by rewrite -totalE; apply: eq_bigr => j _; rewrite error6E.
have small' : (rho < 1)%R by apply/RltP.
have b' (i : 'I_6) : (`|(to_matrix C *m (to_vector w - to_matrix A *m to_vector x0)) i ord0| <= M)%R.
  apply/RleP; rewrite (_ : (_ *m _)%R i ord0 = total (fun k => C i k * (w k - apply6 A x0 k))); first exact: b.
  rewrite mxE -totalE; apply: eq_bigr => k _; rewrite mxE; congr (_ * _)%R.
  by rewrite mxE [X in (_ + X)%R]mxE apply6E mxE.
have [x e [u h]] := solved _ _ _ _ _ rows' small' _ _ _ b'.
have to_x k (l : (k < 6)%N) : from_vector x k = x (Ordinal l) ord0.
  by rewrite /from_vector (_ : inord k = Ordinal l) //; apply/val_inj; rewrite /= inordK.
exists (from_vector x); split; [|split; [|split]].
- move=> i l; rewrite -[i]/(nat_of_ord (Ordinal l)) -apply6E from_vectorK e mxE //.
- move=> z ez i l; rewrite /from_vector -(u (to_vector z)); first by rewrite mxE inordK.
  by apply/matrixP => k j; rewrite (ord1 j) apply6E ez ?ltn_ord // mxE.
- by move=> i l; have := h (Ordinal l); move/RleP; rewrite (to_x i l) mxE [X in (_ + X)%R]mxE mxE.
- move=> i l; pose y := (x - to_vector x0)%R.
  have E : y = (to_matrix C *m (to_vector w - to_matrix A *m to_vector x0) + (1%:M - to_matrix C *m to_matrix A) *m
    y)%R.
    by rewrite -e -mulmxBr mulmxA mulmxBl mul1mx [RHS]addrC subrK.
  have yE (j : 'I_6) : y j ord0 = from_vector x j - x0 j.
    by rewrite /y mxE [X in (_ + X)%R]mxE mxE (to_x j (ltn_ord j)) (_ : Ordinal _ = j) //; apply/val_inj.
  have -> : from_vector x i - x0 i = y (Ordinal l) ord0 by rewrite yE.
  rewrite {1}E mxE; congr (_ + _)%R.
    rewrite mxE -totalE; apply: eq_bigr => k _; rewrite mxE; congr (_ * _)%R.
    by rewrite mxE [X in (_ + X)%R]mxE apply6E mxE.
  by rewrite mxE -totalE; apply: eq_bigr => j _; rewrite error6E yE.
Qed.

(** The same with Coq's own order of natural numbers. *)
Theorem solved_six (A C : nat -> nat -> R) (rho : R) :
  (forall i, lt i 6 -> total (fun j => Rabs (error6 C A i j)) <= rho) -> rho < 1 ->
  forall (w x0 : nat -> R) (M : R),
  (forall i, lt i 6 -> Rabs (total (fun k => C i k * (w k - apply6 A x0 k))) <= M) ->
  exists x, (forall i, lt i 6 -> apply6 A x i = w i) /\
    (forall z, (forall i, lt i 6 -> apply6 A z i = w i) -> forall i, lt i 6 -> z i = x i) /\
    (forall i, lt i 6 -> Rabs (x i - x0 i) * (1 - rho) <= M) /\
    (forall i, lt i 6 -> x i - x0 i = total (fun k => C i k * (w k - apply6 A x0 k)) +
                                      total (fun j => error6 C A i j * (x j - x0 j))).
Proof.
move=> rows small w x0 M b.
have [x [e [u [h k]]]] := solved6 A C rho (fun i l => rows i (elimT ssrnat.ltP l)) small w x0 M (fun i l =>
  b i (elimT ssrnat.ltP l)).
exists x; split; [|split; [|split]].
- by move=> i /ssrnat.ltP l; apply: e.
- by move=> z ez i /ssrnat.ltP l; apply: u => // j /ssrnat.ltP; apply: ez.
- by move=> i /ssrnat.ltP l; apply: h.
- by move=> i /ssrnat.ltP l; apply: k.
Qed.
