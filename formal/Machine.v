(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * From inequalities at a pose to the claim there *)

From Coq Require Import Reals QArith Qreals Lra Lia List FunctionalExtensionality.
From Taut Require Import Statement Loads Turns.
From Taut Require SixEquations.
Open Scope R_scope.

Notation total := SixEquations.total.
Notation apply6 := SixEquations.apply6.
Notation error6 := SixEquations.error6.

Definition nth6 {A : Type} (l : six A) (i : nat) : A :=
  match i with 0%nat => at1 l | 1%nat => at2 l | 2%nat => at3 l | 3%nat => at4 l | 4%nat => at5 l | _ => at6 l end.

Lemma each_of_six (P : nat -> Prop) : P 0%nat -> P 1%nat -> P 2%nat -> P 3%nat -> P 4%nat -> P 5%nat ->
  forall i, (i < 6)%nat -> P i.
Proof. intros a b c d e f i l. do 6 (destruct i as [| i]; [assumption|]). lia. Qed.

(** C (w - A x0) is C w - (C A) x0. *)
Lemma rest_splits (c w x0 : nat -> R) (A : nat -> nat -> R) :
  total (fun k => c k * w k) - total (fun j => total (fun k => c k * A k j) * x0 j) =
  total (fun k => c k * (w k - apply6 A x0 k)).
Proof. unfold SixEquations.apply6, SixEquations.total. ring. Qed.

Section Pose.

Variables (m : machine) (b : built) (P : pose).

Definition lever (a : vec R * vec R) : vec R := arm b P (snd a).
Definition density_column (a : vec R * vec R) : six R :=
  let d := cable_vector P a in
  let k := cross (lever a) d in
  Six (vx d) (vy d) (vz d) (vx k) (vy k) (vz k).
(** Row k, cable i. *)
Definition densities_matrix (k i : nat) : R := nth6 (density_column (nth6 (anchors b) i)) k.
Definition length_of (i : nat) : R := cable_length P (nth6 (anchors b) i).
(** What C makes of how much x0 leaves of a wrench. *)
Definition rest (C : nat -> nat -> R) (x0 : nat -> R) (w : wrench) (i : nat) : R :=
  total (fun k => C i k * (nth6 (six_of w) k - apply6 densities_matrix x0 k)).

Lemma column_part a t :
  six_of (wrench_times t (column b P a)) = map6 (fun e => e * (t / cable_length P a)) (density_column a).
Proof.
  unfold column, force_at, density_column. fold (lever a).
  generalize (cable_vector P a) (cable_length P a) (lever a). intros [c d e] L [x y z].
  cbv [six_of wrench_times times force moment vx vy vz cross map6 at1 at2 at3 at4 at5 at6]. unfold Rdiv. f_equal; ring.
Qed.

Lemma six_of_plus v w : six_of (wrench_plus v w) = zip6 Rplus (six_of v) (six_of w).
Proof. reflexivity. Qed.

Lemma six_of_injective v w : six_of v = six_of w -> v = w.
Proof. destruct v as [[x y z] [d e f]], w as [[x' y' z'] [d' e' f']]. cbv. intros h. injection h. intros. subst.
  reflexivity. Qed.

Lemma balanced_by_densities f k : (k < 6)%nat ->
  nth6 (six_of (balanced b P f)) k = apply6 densities_matrix (fun i => nth6 f i / length_of i) k.
Proof.
  intros l. unfold balanced, fold6, zip6. cbn [at1 at2 at3 at4 at5 at6]. rewrite !six_of_plus, !column_part.
  revert k l. apply each_of_six; reflexivity.
Qed.

Theorem pose_is_feasible tension_margin length_margin (C : nat -> nat -> R) (x0 : nat -> R) (rho : R) :
  (forall i, (i < 6)%nat -> 0 < length_of i) ->
  (forall i, (i < 6)%nat -> total (fun j => Rabs (error6 C densities_matrix i j)) <= rho) -> rho < 1 ->
  (forall i, (i < 6)%nat -> inside (length (nth6 (cables m) i)) length_margin (length_of i)) ->
  (forall w, in_load m b P w -> exists M, (forall i, (i < 6)%nat -> Rabs (rest C x0 w i) <= M) /\
    forall y, (forall i, (i < 6)%nat -> Rabs (y i) * (1 - rho) <= M) ->
    (forall i, (i < 6)%nat -> y i = rest C x0 w i + total (fun j => error6 C densities_matrix i j * y j)) ->
    forall i, (i < 6)%nat -> inside (tension (nth6 (cables m) i)) tension_margin (length_of i * (x0 i + y i))) ->
  feasible_at m b tension_margin length_margin P.
Proof.
  intros positive rows small lengths loads. split.
  { unfold all6, fold6, zip6. cbn [at1 at2 at3 at4 at5 at6].
    repeat split; try (apply (lengths 0%nat); lia); try (apply (lengths 1%nat); lia); try (apply (lengths 2%nat); lia);
      try (apply (lengths 3%nat); lia); try (apply (lengths 4%nat); lia); try (apply (lengths 5%nat); lia). }
  intros w h. destruct (loads w h) as [M [below tensions]].
  destruct (SixEquations.solved_six densities_matrix C rho rows small (nth6 (six_of w)) x0 M below) as [x [e [u [near
    y]]]].
  assert (nonzero : forall i, (i < 6)%nat -> length_of i <> 0) by (intros i l; apply Rgt_not_eq, positive, l).
  set (f := Six (length_of 0 * x 0%nat) (length_of 1 * x 1%nat) (length_of 2 * x 2%nat) (length_of 3 * x 3%nat)
                (length_of 4 * x 4%nat) (length_of 5 * x 5%nat)).
  assert (f_is : forall i, (i < 6)%nat -> nth6 f i = length_of i * x i) by (apply each_of_six; reflexivity).
  assert (same : forall z k, (forall i, (i < 6)%nat -> z i = x i) ->
    apply6 densities_matrix z k = apply6 densities_matrix x k).
  { intros z k a. unfold SixEquations.apply6, SixEquations.total. rewrite !a by lia. reflexivity. }
  exists f. split; [| split].
  - apply six_of_injective.
    assert (r : forall k, (k < 6)%nat -> nth6 (six_of (balanced b P f)) k = nth6 (six_of w) k).
    { intros k l. rewrite balanced_by_densities, <- (e k l) by exact l. apply same.
      intros i li. rewrite f_is by exact li. field. now apply nonzero. }
    destruct (six_of (balanced b P f)), (six_of w).
    f_equal; [apply (r 0%nat) | apply (r 1%nat) | apply (r 2%nat) | apply (r 3%nat) | apply (r 4%nat) |
      apply (r 5%nat)]; lia.
  - intros g hg. 
    assert (r : forall i, (i < 6)%nat -> nth6 g i = nth6 f i).
    { intros i l. rewrite f_is by exact l.
      rewrite <- (u (fun i => nth6 g i / length_of i)); [field; now apply nonzero | | exact l].
      intros k lk. rewrite <- balanced_by_densities by exact lk. now rewrite hg. }
    destruct g. unfold f in *. f_equal; [apply (r 0%nat) | apply (r 1%nat) | apply (r 2%nat) | apply (r 3%nat)
      | apply (r 4%nat) |
      apply (r 5%nat)]; lia.
  - assert (t : forall i, (i < 6)%nat -> inside (tension (nth6 (cables m) i)) tension_margin (nth6 f i)).
    { intros i l. rewrite f_is by exact l. replace (x i) with (x0 i + (x i - x0 i)) by ring.
      exact (tensions (fun i => x i - x0 i) near y i l). }
    unfold all6, fold6, zip6. cbn [at1 at2 at3 at4 at5 at6].
    repeat split; try (apply (t 0%nat); lia); try (apply (t 1%nat); lia); try (apply (t 2%nat); lia);
      try (apply (t 3%nat); lia); try (apply (t 4%nat); lia); try (apply (t 5%nat); lia).
Qed.

End Pose.

(** The statement is about the machine exactly as stated, too: where no tolerance is negative, it is one of those built,
    and every pose one of those meant. *)
Lemma itself_is_built m : (forall i, (i < 6)%nat -> 0 <= fst (nth6 (of_anchors (tolerance m)) i) /\
    0 <= snd (nth6 (of_anchors (tolerance m)) i)) -> 0 <= of_load_point (tolerance m) -> is_built m (itself m).
Proof.
  intros a l. assert (same : forall q v, 0 <= Q2R q -> near q (real_vec v) v).
  { intros q v h. unfold near. now rewrite minus_itself, norm_of_zero. }
  split; [| now apply same].
  assert (both := fun i h => conj (same _ (base (nth6 (cables m) i)) (proj1 (a i h)))
                                  (same _ (platform (nth6 (cables m) i)) (proj2 (a i h)))).
  unfold all6, fold6, zip6, itself, map6. cbn [at1 at2 at3 at4 at5 at6 anchors fst snd].
  repeat split; first [apply (both 0%nat); lia | apply (both 1%nat); lia | apply (both 2%nat); lia |
    apply (both 3%nat); lia | apply (both 4%nat); lia | apply (both 5%nat); lia].
Qed.

Lemma pose_is_tracked m P : 0 <= of_position (tolerance m) -> is_tracked m P P.
Proof.
  intros h. exists (Vec 0 0 0), (Vec 1 0 0), 0. split; [now rewrite norm_of_zero |]. split; [| split].
  - unfold norm, dot. cbn [vx vy vz]. replace (_ + _ + _) with 1 by ring. apply sqrt_1.
  - rewrite Rabs_R0. apply Rabs_pos.
  - destruct P as [[x y z] turn]. cbn [position Statement.turn]. f_equal.
    + unfold plus. cbn [vx vy vz]. f_equal; ring.
    + apply functional_extensionality. intros v. symmetry. apply turn_about_by_nothing.
Qed.
