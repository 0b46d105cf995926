(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Six equations that are nearly linear in a box have exactly one solution there: Banach's fixed point *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From Taut Require Import Machine.
From Taut Require SixEquations.
Open Scope R_scope.

Notation solves g z := (forall i, (i < 6)%nat -> g z i = 0).

Definition in_box (z : nat -> R) : Prop := forall i, (i < 6)%nat -> Rabs (z i) <= 1.

Lemma total_is_below (f : nat -> R) (h : nat -> R) rho M : total (fun j => Rabs (f j)) <= rho -> 0 <= M ->
  (forall j, (j < 6)%nat -> Rabs (h j) <= M) -> Rabs (total (fun j => f j * h j)) <= rho * M.
Proof.
  intros r pos b. apply Rle_trans with (total (fun j => Rabs (f j)) * M); [| now apply Rmult_le_compat_r].
  assert (each : forall j, (j < 6)%nat -> Rabs (f j * h j) <= Rabs (f j) * M).
  { intros j l. rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos | now apply b]. }
  unfold SixEquations.total. assert (e0 := each 0%nat ltac:(lia)). assert (e1 := each 1%nat ltac:(lia)).
  assert (e2 := each 2%nat ltac:(lia)). assert (e3 := each 3%nat ltac:(lia)). assert (e4 := each 4%nat ltac:(lia)).
  assert (e5 := each 5%nat ltac:(lia)).
  set (p0 := f 0%nat * h 0%nat) in *. set (p1 := f 1%nat * h 1%nat) in *. set (p2 := f 2%nat * h 2%nat) in *.
  set (p3 := f 3%nat * h 3%nat) in *. set (p4 := f 4%nat * h 4%nat) in *. set (p5 := f 5%nat * h 5%nat) in *.
  assert (t1 := Rabs_triang (p0 + p1 + p2 + p3 + p4) p5). assert (t2 := Rabs_triang (p0 + p1 + p2 + p3) p4).
  assert (t3 := Rabs_triang (p0 + p1 + p2) p3). assert (t4 := Rabs_triang (p0 + p1) p2).
  assert (t5 := Rabs_triang p0 p1). lra.
Qed.

Lemma total_of_error C A y i : (i < 6)%nat ->
  total (fun j => error6 C A i j * y j) = y i - total (fun k => C i k * apply6 A y k).
Proof.
  revert i. apply each_of_six; unfold SixEquations.error6, SixEquations.apply6, SixEquations.delta, SixEquations.total;
    cbn [Nat.eqb]; ring.
Qed.

Section Equations.

Variables (g : (nat -> R) -> nat -> R) (C : nat -> nat -> R) (guess : nat -> R) (rho within : R).
Hypotheses (small : rho < 1) (inside : forall i, (i < 6)%nat -> Rabs (guess i) + within <= 1)
  (starts : forall i, (i < 6)%nat -> Rabs (total (fun k => C i k * g guess k)) <= within * (1 - rho)).
Hypothesis nearly_linear : forall z z', in_box z -> in_box z' -> exists A : nat -> nat -> R,
  (forall i, (i < 6)%nat -> g z' i - g z i = apply6 A (fun j => z' j - z j) i) /\
  (forall i, (i < 6)%nat -> total (fun j => Rabs (error6 C A i j)) <= rho).

Let step (z : nat -> R) (i : nat) : R := z i - total (fun k => C i k * g z k).

Lemma within_is_positive : 0 <= within.
Proof.
  apply Rmult_le_reg_r with (1 - rho); [lra |]. rewrite Rmult_0_l.
  apply Rle_trans with (2 := starts 0%nat ltac:(lia)). apply Rabs_pos.
Qed.

Lemma guess_in_box : in_box guess.
Proof. intros i l. assert (h := inside i l). assert (p := within_is_positive). lra. Qed.

Lemma rho_is_positive : 0 <= rho.
Proof.
  destruct (nearly_linear _ _ guess_in_box guess_in_box) as [A [_ h]].
  apply Rle_trans with (2 := h 0%nat ltac:(lia)). unfold SixEquations.total.
  repeat apply Rplus_le_le_0_compat; apply Rabs_pos.
Qed.

(** Near the guess is in the box. *)
Lemma near_in_box z : (forall i, (i < 6)%nat -> Rabs (z i - guess i) <= within) -> in_box z.
Proof.
  intros h i l. assert (a := h i l). assert (b := inside i l). assert (t := Rabs_triang (z i - guess i) (guess i)).
  replace (z i - guess i + guess i) with (z i) in t by ring. lra.
Qed.

Lemma step_contracts z z' M : in_box z -> in_box z' -> 0 <= M -> (forall j, (j < 6)%nat -> Rabs (z' j - z j) <= M) ->
  forall i, (i < 6)%nat -> Rabs (step z' i - step z i) <= rho * M.
Proof.
  intros b b' pos d i l. destruct (nearly_linear z z' b b') as [A [eq rows]].
  replace (step z' i - step z i) with (total (fun j => error6 C A i j * (z' j - z j))).
  - apply (total_is_below (error6 C A i) (fun j => z' j - z j)); [now apply rows | exact pos | exact d].
  - rewrite (total_of_error C A (fun j => z' j - z j)) by exact l. unfold step.
    replace (total (fun k => C i k * apply6 A (fun j => z' j - z j) k)) with
      (total (fun k => C i k * g z' k) - total (fun k => C i k * g z k)); [ring |].
    unfold SixEquations.total. rewrite <- !eq by lia. ring.
Qed.

Lemma guess_steps_little i : (i < 6)%nat -> Rabs (step guess i - guess i) <= within * (1 - rho).
Proof.
  intros l. unfold step. replace (_ - _) with (- total (fun k => C i k * g guess k)) by ring.
  rewrite Rabs_Ropp. now apply starts.
Qed.

Let orbit (n : nat) : nat -> R := Nat.iter n step guess.

Lemma orbit_is_near n : forall i, (i < 6)%nat -> Rabs (orbit n i - guess i) <= within.
Proof.
  assert (p := within_is_positive). assert (rp := rho_is_positive).
  induction n as [| n IH]; intros i l; [cbn; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; exact p |].
  change (orbit (S n)) with (step (orbit n)).
  assert (c : Rabs (step (orbit n) i - step guess i) <= rho * within)
    by (apply step_contracts; [apply guess_in_box | now apply near_in_box | exact p | exact IH | exact l]).
  assert (z := guess_steps_little i l). assert (t := Rabs_triang (step (orbit n) i - step guess i) (step guess i -
    guess i)).
  replace (step (orbit n) i - step guess i + (step guess i - guess i)) with (step (orbit n) i - guess i) in t by ring.
    lra.
Qed.

Lemma orbit_in_box n : in_box (orbit n).
Proof. apply near_in_box, orbit_is_near. Qed.

Lemma orbit_slows n : forall i, (i < 6)%nat -> Rabs (orbit (S n) i - orbit n i) <= rho ^ n * (within * (1 - rho)).
Proof.
  induction n as [| n IH]; intros i l; [cbn [pow]; rewrite Rmult_1_l; now apply guess_steps_little |].
  change (Rabs (step (orbit (S n)) i - step (orbit n) i) <= rho * rho ^ n * (within * (1 - rho))). rewrite Rmult_assoc.
  apply step_contracts; try apply orbit_in_box; [| exact IH | exact l].
  apply Rmult_le_pos; [apply pow_le, rho_is_positive |]. apply Rmult_le_pos; [apply within_is_positive | lra].
Qed.

Lemma orbit_converges i : (i < 6)%nat -> exists x : R, is_lim_seq (fun n => orbit n i) x.
Proof.
  intros l. set (d := fun n => orbit (S n) i - orbit n i).
  assert (e : ex_series d).
  { apply (ex_series_le d (fun n => rho ^ n * (within * (1 - rho)))); [intros n; exact (orbit_slows n i l) |].
    destruct (ex_series_geom rho) as [v hv]; [rewrite Rabs_pos_eq by apply rho_is_positive; exact small |].
    exists (within * (1 - rho) * v). apply (is_series_ext (fun n => scal (within * (1 - rho)) (rho ^ n))); [intros n;
      apply Rmult_comm |].
    exact (is_series_scal (within * (1 - rho)) _ v hv). }
  destruct e as [x h]. exists (x + guess i). apply is_lim_seq_incr_1.
  apply (is_lim_seq_ext (fun n => sum_n d n + guess i)).
  2: { apply (is_lim_seq_plus' _ (fun _ => guess i) x (guess i)); [exact h | apply is_lim_seq_const]. }
  intros n. induction n as [| n IH].
  - rewrite sum_O. unfold d. change (orbit 0 i) with (guess i). ring.
  - rewrite sum_Sn. replace (sum_n d n) with (orbit (S n) i - guess i) by lra. unfold d, plus. cbn. ring.
Qed.

Lemma eventually_each (P : nat -> nat -> Prop) : (forall j, (j < 6)%nat -> eventually (P j)) ->
  eventually (fun n => forall j, (j < 6)%nat -> P j n).
Proof.
  intros h. assert (k : forall n, (n <= 6)%nat -> eventually (fun k => forall j, (j < n)%nat -> P j k)).
  { induction n as [| n IH]; intros l; [exists 0%nat; intros; lia |].
    destruct (IH ltac:(lia)) as [a ha]. destruct (h n ltac:(lia)) as [b hb]. exists (Nat.max a b). intros k lk j lj.
    destruct (Nat.eq_dec j n) as [-> | ne]; [apply hb; lia | apply ha; lia]. }
  exact (k 6%nat ltac:(lia)).
Qed.

Theorem one_solution : exists z, (forall i, (i < 6)%nat -> Rabs (z i - guess i) <= within) /\ solves g z /\
  forall z', in_box z' -> solves g z' -> forall i, (i < 6)%nat -> z' i = z i.
Proof.
  destruct (orbit_converges 0 ltac:(lia)) as [x0 h0]. destruct (orbit_converges 1 ltac:(lia)) as [x1 h1].
  destruct (orbit_converges 2 ltac:(lia)) as [x2 h2]. destruct (orbit_converges 3 ltac:(lia)) as [x3 h3].
  destruct (orbit_converges 4 ltac:(lia)) as [x4 h4]. destruct (orbit_converges 5 ltac:(lia)) as [x5 h5].
  set (z := fun i => match i with 0%nat => x0 | 1%nat => x1 | 2%nat => x2 | 3%nat => x3 | 4%nat => x4 | _ => x5 end).
  assert (lim : forall i, (i < 6)%nat -> is_lim_seq (fun n => orbit n i) (z i)) by (apply each_of_six; assumption).
  assert (close : forall i, (i < 6)%nat -> Rabs (z i - guess i) <= within).
  { intros i l. apply (is_lim_seq_le (fun n => Rabs (orbit n i - guess i)) (fun _ =>
    within) (Rabs (z i - guess i)) within).
    - intros n. now apply orbit_is_near.
    - apply (is_lim_seq_abs _ (z i - guess i)).
      apply (is_lim_seq_minus' _ (fun _ => guess i) (z i) (guess i)); [now apply lim | apply is_lim_seq_const].
    - apply is_lim_seq_const. }
  assert (boxed : in_box z) by now apply near_in_box.
  assert (fixed : forall i, (i < 6)%nat -> step z i = z i).
  { intros i l. destruct (Req_dec (step z i) (z i)) as [e | n]; [exact e |]. exfalso.
    assert (pos : 0 < Rabs (step z i - z i) / 3) by (apply Rdiv_lt_0_compat; [apply Rabs_pos_lt; lra | lra]).
    set (eps := mkposreal _ pos).
    assert (soon : eventually (fun n => forall j, (j < 6)%nat -> Rabs (orbit n j - z j) < eps)).
    { apply eventually_each. intros j lj. exact (proj2 (is_lim_seq_spec _ _) (lim j lj) eps). }
    destruct soon as [k soon].
    assert (a : Rabs (step z i - step (orbit k) i) <= rho * eps).
    { apply step_contracts; [apply orbit_in_box | exact boxed | apply Rlt_le, cond_pos | | exact l].
      intros j lj. rewrite Rabs_minus_sym. apply Rlt_le, soon; [apply le_n | exact lj]. }
    assert (b : Rabs (step (orbit k) i - z i) < eps) by (apply (soon (S k)); [lia | exact l]).
    assert (c := Rabs_triang (step z i - step (orbit k) i) (step (orbit k) i - z i)).
    replace (step z i - step (orbit k) i + (step (orbit k) i - z i)) with (step z i - z i) in c by ring.
    assert (r := rho_is_positive). assert (e : eps = Rabs (step z i - z i) / 3 :> R) by reflexivity.
    assert (rho * eps <= 1 * eps) by (apply Rmult_le_compat_r; lra). lra. }
  assert (solved : solves g z).
  { destruct (nearly_linear z z boxed boxed) as [A [_ rows]].
    destruct (SixEquations.solved_six A C rho rows small (g z) (fun _ => 0) 0) as [x [eq [_ [zero _]]]].
    + intros i l. assert (f := fixed i l). unfold step in f.
      replace (total _) with (total (fun k => C i k * g z k));
        [replace (total (fun k => C i k * g z k)) with 0 by lra; rewrite Rabs_R0; lra |].
      unfold SixEquations.apply6, SixEquations.total. ring.
    + assert (x_is_0 : forall i, (i < 6)%nat -> x i = 0).
      { intros i l. assert (h := zero i l). rewrite Rminus_0_r in h. assert (p := Rabs_pos (x i)).
        destruct (Req_dec (x i) 0) as [e | n]; [exact e |]. apply Rabs_pos_lt in n. nra. }
      intros i l. rewrite <- eq by exact l. unfold SixEquations.apply6, SixEquations.total.
      rewrite !x_is_0 by lia. ring. }
  exists z. split; [exact close | split; [exact solved |]].
  intros z' b' s'. destruct (nearly_linear z z' boxed b') as [A [eq rows]].
    destruct (SixEquations.solved_six A C rho rows small (fun _ => 0) (fun _ => 0) 0) as [x [_ [only _]]].
    + intros i l. replace (total _) with 0; [rewrite Rabs_R0; lra |].
      unfold SixEquations.apply6, SixEquations.total. ring.
    + intros i l. assert (h := only (fun j => z' j - z j)). assert (here := only (fun _ => 0)).
      assert (e : z' i - z i = x i).
      { apply h; [| exact l]. intros j lj. rewrite <- eq by exact lj. rewrite s', solved by exact lj. ring. }
      assert (e0 : 0 = x i).
      { apply here; [| exact l]. intros j lj. unfold SixEquations.apply6, SixEquations.total. ring. }
      lra.
Qed.

End Equations.
