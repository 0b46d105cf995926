(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What wrenches of a load's items can make of a row: y.w, over the real numbers

    A row y is a pair of vectors: y.w is [fst y . force w + snd y . moment w]. *)

From Coq Require Import Reals QArith Qreals Lra List.
From Taut Require Import Statement Lemmas.
Open Scope R_scope.

Definition row : Type := vec R * vec R.
Definition along_row (y : row) (w : wrench) : R := dot (fst y) (force w) + dot (snd y) (moment w).

(** What a force of one newton along each axis makes of y, where its arm from the load point is r. *)
Definition covector (y : row) (r : vec R) : vec R := plus (fst y) (cross (snd y) r).

(** A covector in the axes in which forces are stated: that for the platform's has those of the images of its axes. *)
Definition unit_x : vec R := Vec 1 0 0.
Definition unit_y : vec R := Vec 0 1 0.
Definition unit_z : vec R := Vec 0 0 1.
Definition seen_from (a : axes) (turn : vec R -> vec R) (h : vec R) : vec R :=
  match a with
  | OfWorld => h
  | OfPlatform => Vec (dot (turn unit_x) h) (dot (turn unit_y) h) (dot (turn unit_z) h)
  end.

Ltac by_coordinates := intros; repeat match goal with v : vec R |- _ => destruct v end;
  unfold plus, minus, times, cross, dot; cbn [vx vy vz fst snd]; first [ring | f_equal; ring].

(** ** Vectors *)

Lemma norm_is_positive v : 0 <= norm v.
Proof. apply sqrt_pos. Qed.

Lemma dot_is_square v : dot v v = norm v * norm v.
Proof. unfold norm. rewrite sqrt_sqrt; [reflexivity |]. unfold dot. nra. Qed.

Lemma lagrange u v : dot u v * dot u v + dot (cross u v) (cross u v) = dot u u * dot v v.
Proof. revert u v. by_coordinates. Qed.

Lemma abs_below a b : 0 <= b -> a * a <= b * b -> Rabs a <= b.
Proof. intros p h. apply Rabs_le. split; nra. Qed.

Lemma dot_is_below u v : Rabs (dot u v) <= norm u * norm v.
Proof.
  assert (a := norm_is_positive u). assert (b := norm_is_positive v).
  apply abs_below; [now apply Rmult_le_pos |].
  assert (h := lagrange u v). rewrite (dot_is_square (cross u v)), (dot_is_square u), (dot_is_square v) in h.
  assert (0 <= norm (cross u v) * norm (cross u v)) by apply Rle_0_sqr. lra.
Qed.

Lemma coordinates_are_below v : Rabs (vx v) <= norm v /\ Rabs (vy v) <= norm v /\ Rabs (vz v) <= norm v.
Proof.
  assert (p := norm_is_positive v). assert (s := dot_is_square v). unfold dot in s.
  assert (a := Rle_0_sqr (vx v)). assert (b := Rle_0_sqr (vy v)). assert (c := Rle_0_sqr (vz v)). unfold Rsqr in *.
  split; [| split]; apply abs_below; lra.
Qed.

Lemma norm_of_plus u v : norm (plus u v) <= norm u + norm v.
Proof.
  assert (a := norm_is_positive u). assert (b := norm_is_positive v). assert (c := norm_is_positive (plus u v)).
  rewrite <- (Rabs_pos_eq _ c). apply abs_below; [lra |]. rewrite <- dot_is_square.
  replace (dot (plus u v) (plus u v)) with (dot u u + 2 * dot u v + dot v v) by (clear; revert u v; by_coordinates).
  rewrite !dot_is_square. assert (h := dot_is_below u v). assert (k := Rle_abs (dot u v)). nra.
Qed.

Lemma norm_of_times k v : norm (times k v) = Rabs k * norm v.
Proof.
  unfold norm. replace (dot (times k v) (times k v)) with (Rsqr k * dot v v) by (unfold Rsqr; revert v; by_coordinates).
  rewrite sqrt_mult_alt by apply Rle_0_sqr. now rewrite sqrt_Rsqr_abs.
Qed.

Lemma norm_of_zero : norm (Vec 0 0 0) = 0.
Proof. unfold norm, dot. cbn [vx vy vz]. replace (_ + _ + _) with 0 by ring. apply sqrt_0. Qed.

Lemma norm_is_zero v : norm v <= 0 -> v = Vec 0 0 0.
Proof.
  intros h. assert (z : dot v v = 0) by (rewrite dot_is_square; assert (p := norm_is_positive v); nra).
  destruct v as [x y w]. unfold dot in z. cbn in z. f_equal; nra.
Qed.

Lemma minus_itself v : minus v v = Vec 0 0 0.
Proof. revert v. by_coordinates. Qed.

(** Of a vector across n only what h has across n counts. *)
Lemma dot_across h v n : dot v n = 0 -> norm n <> 0 -> Rabs (dot h v) <= norm v * norm (cross n h) / norm n.
Proof.
  intros across z.
  assert (p : 0 < norm n) by (assert (q := norm_is_positive n); lra).
  assert (a := norm_is_positive v). assert (b := norm_is_positive (cross n h)).
  assert (e : dot (cross n h) (cross n v) = dot n n * dot h v - dot v n * dot h n) by (clear; by_coordinates).
  assert (s : dot (cross n v) (cross n v) = (norm n * norm v) * (norm n * norm v)).
  { assert (l := lagrange n v). replace (dot n v) with (dot v n) in l by (clear; by_coordinates).
    rewrite across, (dot_is_square n), (dot_is_square v) in l. lra. }
  assert (len : norm (cross n v) = norm n * norm v).
  { unfold norm at 1. rewrite s. apply sqrt_square. apply Rmult_le_pos; lra. }
  assert (h1 := dot_is_below (cross n h) (cross n v)). rewrite e, across, len, dot_is_square in h1.
  replace (norm n * norm n * dot h v - 0 * dot h n) with (norm n * norm n * dot h v) in h1 by ring.
  rewrite !Rabs_mult, (Rabs_pos_eq (norm n)) in h1 by lra.
  apply Rmult_le_reg_l with (norm n * norm n); [now apply Rmult_lt_0_compat |].
  replace (norm n * norm n * (norm v * norm (cross n h) / norm n)) with (norm (cross n h) * (norm n * norm v))
    by (field; lra).
  exact h1.
Qed.

(** ** Rows and wrenches *)

Lemma along_plus y v w : along_row y (wrench_plus v w) = along_row y v + along_row y w.
Proof. destruct y as [a b], v as [c d], w as [e f]. unfold along_row, wrench_plus. cbn [force moment fst snd].
  by_coordinates. Qed.

Lemma along_times y k w : along_row y (wrench_times k w) = k * along_row y w.
Proof. destruct y as [a b], w as [e f]. unfold along_row, wrench_times. cbn [force moment fst snd]. by_coordinates. Qed.

Lemma along_force b P y point f : along_row y (force_at b P point f) = dot (covector y (arm b P point)) f.
Proof.
  destruct y as [h k]. unfold along_row, force_at, covector. cbn [force moment fst snd]. generalize (arm b P point).
    by_coordinates.
Qed.

Lemma along_moment y v : along_row y (pure_moment v) = dot (snd y) v.
Proof. destruct y as [a b]. unfold along_row, pure_moment. cbn [force moment fst snd]. by_coordinates. Qed.

(** ** Sets of vectors *)

Lemma ball_is_below r v h : in_vectors (Ball r) v -> Rabs (dot h v) <= Q2R r * norm h.
Proof.
  cbn. intros b. assert (a := dot_is_below h v). assert (p := norm_is_positive h).
  apply Rle_trans with (norm h * norm v); [exact a |]. rewrite Rmult_comm. now apply Rmult_le_compat_r.
Qed.

Lemma disc_is_below r n v h : in_vectors (Disc r n) v -> norm (real_vec n) <> 0 ->
  Rabs (dot h v) <= Q2R r * norm (cross (real_vec n) h) / norm (real_vec n).
Proof.
  cbn. intros [b across] z. apply Rle_trans with (1 := dot_across h v (real_vec n) across z).
  assert (p := norm_is_positive (cross (real_vec n) h)).
  assert (q : 0 < norm (real_vec n)) by (assert (q := norm_is_positive (real_vec n)); lra).
  unfold Rdiv. apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat |]. now apply Rmult_le_compat_r.
Qed.

(** Near the middle of a segment. *)
Lemma segment_is_near e l u v h : in_vectors (Along e l u) v -> exists f : R,
  Rabs (f - (Q2R l + Q2R u) * / 2) <= (Q2R u - Q2R l) * / 2 /\
  dot h v = f * (dot h (real_vec e) / norm (real_vec e)).
Proof.
  cbn. intros [f [b ->]]. exists f. split; [apply Rabs_le; lra |].
  unfold Rdiv. generalize (/ norm (real_vec e)), (real_vec e). intros k w. revert h w. by_coordinates.
Qed.

(** ** A weight *)

Lemma weight_is_near (k l u a b t : R) : l <= k <= u -> Rabs b <= t ->
  Rabs (k * (a + b) - (l + u) * / 2 * a) <= (u - l) * / 2 * Rabs a + (Rabs ((l + u) * / 2) + (u - l) * / 2) * t.
Proof.
  intros hk hb.
  replace (k * (a + b) - (l + u) * / 2 * a) with ((k - (l + u) * / 2) * a + k * b) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult _ a), (Rabs_mult k b).
  apply Rplus_le_compat; apply Rmult_le_compat; try apply Rabs_pos; try exact hb; try apply Rle_refl.
  - apply Rabs_le. lra.
  - replace k with ((l + u) * / 2 + (k - (l + u) * / 2)) at 1 by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat_l. apply Rabs_le. lra.
Qed.

(** ** Vectors by their parts *)

Lemma plus_of_minus u c : plus c (minus u c) = u.
Proof. revert u c. intros [x y z] [x' y' z']. unfold plus, minus. cbn [vx vy vz]. f_equal; ring. Qed.

Lemma minus_in_two_steps u p c : minus u p = plus (minus c p) (minus u c).
Proof. revert u p c. by_coordinates. Qed.

Lemma minus_of_nearby u p c l : minus u p = plus (minus c l) (plus (minus u c) (times (- 1) (minus p l))).
Proof. revert u p c l. by_coordinates. Qed.

Definition combination (u x y z : vec R) : vec R := plus (plus (times (vx u) x) (times (vy u) y)) (times (vz u) z).

Lemma combination_of_plus u w x y z : combination (plus u w) x y z = plus (combination u x y z) (combination w x y z).
Proof. unfold combination. revert u w x y z. by_coordinates. Qed.

Lemma dot_of_combination h u x y z : dot h (combination u x y z) = dot (Vec (dot x h) (dot y h) (dot z h)) u.
Proof. unfold combination. revert h u x y z. by_coordinates. Qed.

Lemma dot_of_moved y a d g mass : dot (covector y (plus a d)) (times mass g) =
  mass * (dot (covector y a) g + dot d (cross g (snd y))).
Proof. unfold covector. destruct y as [f k]. revert f k a d g. by_coordinates. Qed.
