(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * A matrix with a good approximate inverse is regular, and what its solutions are near to *)

From mathcomp Require Import all_ssreflect all_algebra.
Import GRing.Theory Num.Theory Order.Theory.
Local Open Scope ring_scope.

Section Neumann.

Variables (F : realFieldType) (n : nat) (A C : 'M[F]_n.+1) (rho : F).
Let E : 'M[F]_n.+1 := 1%:M - C *m A.
Hypothesis rows : forall i, \sum_j `|E i j| <= rho.
Hypothesis small : rho < 1.

Lemma bound (w y : 'cV[F]_n.+1) (M : F) : y = w + E *m y -> (forall i, `|w i 0| <= M) ->
  forall i, `|y i 0| * (1 - rho) <= M.
Proof.
move=> e b i.
have [k top] : exists k, forall j, `|y j 0| <= `|y k 0|.
  by case: (@Order.TotalTheory.arg_maxP _ F [finType of 'I_n.+1] ord0 predT (fun j => `|y j 0|) isT) => k _ h;
    exists k => j; apply: h.
have s : `|y k 0| <= M + rho * `|y k 0|.
  rewrite {1}e mxE; apply: le_trans (ler_norm_add _ _) _; apply: ler_add; first exact: b.
  rewrite mxE; apply: le_trans (ler_norm_sum _ _ _) _.
  apply: (@le_trans _ _ (\sum_j `|E k j| * `|y k 0|)).
    by apply: ler_sum => j _; rewrite normrM; apply: ler_wpmul2l.
  by rewrite -mulr_suml; apply: ler_wpmul2r.
apply: (@le_trans _ _ (`|y k 0| * (1 - rho))).
  by apply: ler_wpmul2r => //; rewrite subr_ge0 ltW.
by rewrite mulrBr mulr1 ler_subl_addr [_ * rho]mulrC.
Qed.

Lemma regular : A \in unitmx.
Proof.
rewrite -unitmx_tr -row_free_unit -kermx_eq0.
have := mulmx_ker A^T; move: (kermx A^T) => K z0.
have z : A *m K^T = 0 by rewrite -[A]trmxK -trmx_mul z0 trmx0.
apply/eqP/matrixP => i j; rewrite [RHS]mxE.
have e : col i K^T = 0 + E *m col i K^T.
  by rewrite add0r /E mulmxBl mul1mx -mulmxA colE [A *m _]mulmxA z mul0mx mulmx0 subr0.
have b k : `|(0 : 'cV[F]_n.+1) k 0| <= 0 by rewrite mxE normr0.
have := @bound 0 _ 0 e b j.
by rewrite pmulr_lle0 ?subr_gt0 // normr_le0 mxE mxE => /eqP.
Qed.

(** Exactly one x has A x = w, and it is within M / (1 - rho) of x0 in each coordinate. *)
Theorem solved (w x0 : 'cV[F]_n.+1) (M : F) : (forall i, `|(C *m (w - A *m x0)) i 0| <= M) ->
  exists2 x, A *m x = w & (forall z, A *m z = w -> z = x) /\ forall i, `|(x - x0) i 0| * (1 - rho) <= M.
Proof.
move=> b; have u := regular; exists (invmx A *m w); first by rewrite mulKVmx.
split=> [z <- | i]; first by rewrite mulKmx.
have ay : A *m (invmx A *m w - x0) = w - A *m x0 by rewrite mulmxBr mulKVmx.
apply: (@bound (C *m (w - A *m x0)) _ M _ b).
by rewrite -ay mulmxA /E mulmxBl mul1mx [RHS]addrC subrK.
Qed.

End Neumann.

Print Assumptions solved.
