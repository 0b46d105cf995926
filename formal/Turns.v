(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Turns about an axis, and by quaternions *)

From Coq Require Import Reals QArith Qreals Lra List.
From Taut Require Import Statement Lemmas Loads.
Open Scope R_scope.

(** ** Turns about an axis *)

Lemma sin_is_below a : Rabs (sin a) <= Rabs a.
Proof.
  destruct (sin_between 0 a) as [x [_ e]]. rewrite sin_0, Rminus_0_r in e.
  replace (sin a) with (cos x * a) by lra. rewrite Rabs_mult. assert (c := COS_bound x).
  rewrite <- (Rmult_1_l (Rabs a)) at 2. apply Rmult_le_compat_r; [apply Rabs_pos |]. now apply Rabs_le.
Qed.

(** A chord is no longer than its arc: 2 - 2 cos a = (2 sin (a / 2))^2. *)
Lemma chord_is_below a : 2 - 2 * cos a <= a * a.
Proof.
  assert (e : cos a = 1 - 2 * sin (a / 2) * sin (a / 2)) by (replace a with (2 * (a / 2)) at 1 by field;
    apply cos_2a_sin).
  assert (h := sin_is_below (a / 2)). apply Rsqr_le_abs_1 in h. unfold Rsqr in h. rewrite e. nra.
Qed.

Lemma one_of_cos a : cos a * cos a = 1 - sin a * sin a.
Proof. assert (h := sin2_cos2 a). unfold Rsqr in h. lra. Qed.

Lemma turn_about_is_linear n a u x y z : turn_about n a (combination u x y z) =
  combination u (turn_about n a x) (turn_about n a y) (turn_about n a z).
Proof. unfold turn_about, combination. generalize (cos a), (sin a). revert n u x y z. by_coordinates. Qed.

Lemma turn_about_of_sum n a t u k : turn_about n a (plus u (times t k)) = plus (turn_about n a u) (times t (turn_about
  n a k)).
Proof. unfold turn_about. generalize (cos a), (sin a). revert n u k. by_coordinates. Qed.

Lemma turn_about_by_nothing n u : turn_about n 0 u = u.
Proof. unfold turn_about. rewrite cos_0, sin_0. revert n u. by_coordinates. Qed.

Lemma turn_about_keeps_dot n a u v : norm n = 1 -> dot (turn_about n a u) (turn_about n a v) = dot u v.
Proof.
  intros unit. assert (one : dot n n = 1) by (rewrite dot_is_square, unit; ring). assert (c := one_of_cos a).
  assert (e : dot (turn_about n a u) (turn_about n a v) = cos a * cos a * dot u v +
    sin a * sin a * (dot n n * dot u v - dot n u * dot n v) +
    (2 * cos a * (1 - cos a) + (1 - cos a) * (1 - cos a) * dot n n) * (dot n u * dot n v)).
  { unfold turn_about. generalize (cos a), (sin a). clear. revert n u v. by_coordinates. }
  rewrite e, one.
  replace (_ + _ + _) with ((cos a * cos a) * (dot u v - dot n u * dot n v) +
    sin a * sin a * (dot u v - dot n u * dot n v) + dot n u * dot n v) by ring.
  rewrite c. ring.
Qed.

(** Nothing is moved by more than the angle times its length. *)
Lemma turn_about_moves_little n a u : norm n = 1 -> norm (minus (turn_about n a u) u) <= Rabs a * norm u.
Proof.
  intros unit. assert (one : dot n n = 1) by (rewrite dot_is_square, unit; ring). assert (c := one_of_cos a).
  assert (p := norm_is_positive (minus (turn_about n a u) u)).
  assert (q := Rmult_le_pos _ _ (Rabs_pos a) (norm_is_positive u)).
  rewrite <- (Rabs_pos_eq _ p). apply abs_below; [exact q |].
  rewrite <- dot_is_square.
  assert (e : dot (minus (turn_about n a u) u) (minus (turn_about n a u) u) =
    sin a * sin a * (dot n n * dot u u - dot n u * dot n u) +
    (1 - cos a) * (1 - cos a) * (dot u u - 2 * (dot n u * dot n u) + dot n n * (dot n u * dot n u))).
  { unfold turn_about. generalize (cos a), (sin a). clear. revert n u. by_coordinates. }
  rewrite e, one.
  replace (_ + _) with ((2 - 2 * cos a) * (dot u u - dot n u * dot n u)).
  - replace (Rabs a * norm u * (Rabs a * norm u)) with (a * a * dot u u).
    + assert (l := lagrange n u). rewrite one, (dot_is_square (cross n u)) in l.
      assert (0 <= norm (cross n u) * norm (cross n u)) by apply Rle_0_sqr.
      assert (0 <= dot n u * dot n u) by apply Rle_0_sqr.
      assert (k := chord_is_below a). assert (cb := COS_bound a). nra.
    + rewrite dot_is_square. replace (a * a) with (Rabs a * Rabs a); [ring |].
      rewrite <- Rabs_mult. apply Rabs_pos_eq, Rle_0_sqr.
  - replace (sin a * sin a) with (1 - cos a * cos a) by lra. ring.
Qed.

(** For angles of up to a right one it moves u by w × (u + d), where w, along the axis, and d are small. *)
Definition moves_about (n : vec R) (a : R) : vec R := times (sin a) n.

Lemma turn_about_is_cross n a u : norm n = 1 -> 0 <= cos a -> exists d, norm d <= Rabs a * norm u /\
  turn_about n a u = plus u (cross (moves_about n a) (plus u d)).
Proof.
  intros unit pos. assert (one : dot n n = 1) by (rewrite dot_is_square, unit; ring). assert (c := one_of_cos a).
  set (q := sin a / (1 + cos a)). exists (times q (cross n u)). split.
  - rewrite norm_of_times.
    assert (hq : Rabs q <= Rabs a).
    { unfold q, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ _)) by (left; apply Rinv_0_lt_compat; lra).
      apply Rle_trans with (2 := sin_is_below a). rewrite <- (Rmult_1_r (Rabs (sin a))) at 2.
      apply Rmult_le_compat_l; [apply Rabs_pos |]. rewrite <- Rinv_1. apply Rinv_le_contravar; lra. }
    assert (hc : norm (cross n u) <= norm u).
    { rewrite <- (Rabs_pos_eq _ (norm_is_positive (cross n u))). apply abs_below; [apply norm_is_positive |].
      assert (l := lagrange n u). rewrite one, (dot_is_square (cross n u)), (dot_is_square u) in l.
      assert (0 <= dot n u * dot n u) by apply Rle_0_sqr. lra. }
    apply Rmult_le_compat; try assumption; [apply Rabs_pos | apply norm_is_positive].
  - assert (hs : sin a * q = 1 - cos a).
    { unfold q. apply Rmult_eq_reg_r with (1 + cos a); [| lra].
      replace (sin a * (sin a / (1 + cos a)) * (1 + cos a)) with (sin a * sin a) by (field; lra). lra. }
    assert (e : plus u (cross (moves_about n a) (plus u (times q (cross n u)))) =
      plus (plus u (times (sin a) (cross n u))) (times (sin a * q) (minus (times (dot n u) n) (times (dot n n) u)))).
    { unfold moves_about. generalize (sin a). intros x. clearbody q. clear. revert n u. by_coordinates. }
    rewrite e, hs, one. unfold turn_about. generalize (cos a), (sin a). clear. revert n u. by_coordinates.
Qed.

Lemma turn_about_axis_is_linear n a u :
  turn_about n a u = combination u (turn_about n a unit_x) (turn_about n a unit_y) (turn_about n a unit_z).
Proof. rewrite <- turn_about_is_linear. f_equal. unfold combination, unit_x, unit_y, unit_z. revert u. by_coordinates.
  Qed.

Lemma unit_along_is_unit v : v <> Vec 0 0 0 -> norm (unit_along v) = 1.
Proof.
  intros h. assert (n : norm v <> 0) by (intros e; apply h, norm_is_zero; lra).
  unfold unit_along. rewrite norm_of_times, Rabs_pos_eq; [now apply Rinv_l |].
  left. apply Rinv_0_lt_compat. assert (p := norm_is_positive v). lra.
Qed.

(** ** Quaternions *)

Lemma turn_by_is_linear q u x y z :
  turn_by q (combination u x y z) = combination u (turn_by q x) (turn_by q y) (turn_by q z).
Proof.
  destruct q as [v w]. unfold turn_by. cbn [vector_part scalar_part]. generalize (/ (dot v v + w * w)). intros k.
  unfold combination. revert v u x y z. by_coordinates.
Qed.

Lemma turn_by_of_units q u : turn_by q u = combination u (turn_by q unit_x) (turn_by q unit_y) (turn_by q unit_z).
Proof.
  rewrite <- turn_by_is_linear. f_equal. unfold combination, unit_x, unit_y, unit_z. revert u. by_coordinates.
Qed.

Definition square (q : quaternion) : R := dot (vector_part q) (vector_part q) + scalar_part q * scalar_part q.

Lemma turn_by_keeps_dot q u w : square q <> 0 -> dot (turn_by q u) (turn_by q w) = dot u w.
Proof.
  destruct q as [[a b c] d], u as [x y z], w as [x' y' z'].
  unfold square, turn_by, dot, times, plus, cross. cbn [vector_part scalar_part vx vy vz]. intros h. now field.
Qed.

Lemma square_of_between p q : square (between p q) = square p * square q.
Proof.
  destruct p as [[a b c] d], q as [[e f g] h].
  unfold square, between, dot, minus, times, cross. cbn [vector_part scalar_part vx vy vz]. ring.
Qed.

Lemma square_is_positive q : scalar_part q <> 0 -> 0 < square q.
Proof.
  destruct q as [v w]. unfold square. cbn [vector_part scalar_part]. intros h.
  assert (p := Rle_0_sqr w). assert (s : 0 < w * w) by (apply Rsqr_pos_lt in h; exact h).
  rewrite dot_is_square. assert (n := Rle_0_sqr (norm v)). unfold Rsqr in n. lra.
Qed.

(** Where this is not 0, no quaternion is. *)
Lemma squares_are_not_0 p q : scalar_part (between p q) <> 0 -> square p <> 0 /\ square q <> 0.
Proof.
  intros h. apply square_is_positive in h. rewrite square_of_between in h. split; intros z; rewrite z in h; lra.
Qed.

(** The turn by r and then by p, and a quaternion of another length. *)
Definition after (p r : quaternion) : quaternion :=
  Quaternion (plus (plus (times (scalar_part p) (vector_part r)) (times (scalar_part r) (vector_part p)))
                   (cross (vector_part p) (vector_part r)))
             (scalar_part p * scalar_part r - dot (vector_part p) (vector_part r)).
Definition longer (k : R) (q : quaternion) : quaternion := Quaternion (times k (vector_part q)) (k * scalar_part q).

(** From the turn by the one to that by the other, in the world's axes: q times the conjugate of p. *)
Definition onward (p q : quaternion) : quaternion :=
  Quaternion (minus (minus (times (scalar_part p) (vector_part q)) (times (scalar_part q) (vector_part p)))
                    (cross (vector_part q) (vector_part p)))
             (scalar_part p * scalar_part q + dot (vector_part q) (vector_part p)).

Ltac by_parts_of_quaternions := cbv [after longer onward between square dot minus plus times cross vector_part
  scalar_part vx vy vz]; first [ring | f_equal; [f_equal |]; ring].

Lemma after_between p q : after p (between p q) = longer (square p) q.
Proof. destruct p as [[a b c] d], q as [[e f g] h]. by_parts_of_quaternions. Qed.

Lemma after_onward p q : after (onward p q) p = longer (square p) q.
Proof. destruct p as [[a b c] d], q as [[e f g] h]. by_parts_of_quaternions. Qed.

Lemma square_of_after p r : square (after p r) = square p * square r.
Proof. destruct p as [[a b c] d], r as [[e f g] h]. by_parts_of_quaternions. Qed.

Lemma square_of_onward p q : square (onward p q) = square p * square q.
Proof. destruct p as [[a b c] d], q as [[e f g] h]. by_parts_of_quaternions. Qed.

Lemma turn_by_after p r u : square p <> 0 -> square r <> 0 -> turn_by p (turn_by r u) = turn_by (after p r) u.
Proof.
  intros hp hr. unfold turn_by. fold (square p) (square r) (square (after p r)). rewrite square_of_after.
  revert hp hr. generalize (square p), (square r). intros k l hk hl.
  destruct p as [[a b c] d], r as [[e f g] h], u as [x y z].
  cbv [after dot plus minus times cross vector_part scalar_part vx vy vz]. f_equal; field; split; assumption.
Qed.

Lemma turn_by_longer k q u : k <> 0 -> square q <> 0 -> turn_by (longer k q) u = turn_by q u.
Proof.
  intros hk hq. assert (e : square (longer k q) = k * k * square q)
    by (destruct q as [[a b c] d]; by_parts_of_quaternions).
  unfold turn_by. fold (square q) (square (longer k q)). rewrite e. revert hq. generalize (square q). intros l hl.
  destruct q as [[a b c] d], u as [x y z].
  cbv [longer dot plus minus times cross vector_part scalar_part vx vy vz]. f_equal; field; split; assumption.
Qed.

(** From the one quaternion's axes, [between] leads to the other's; and from its turn, [onward] does. *)
Lemma turn_by_between p q u : square p <> 0 -> square q <> 0 -> turn_by p (turn_by (between p q) u) = turn_by q u.
Proof.
  intros hp hq. rewrite turn_by_after, after_between; [now apply turn_by_longer | exact hp |].
  rewrite square_of_between. now apply Rmult_integral_contrapositive.
Qed.

Lemma turn_by_onward p q u : square p <> 0 -> square q <> 0 -> turn_by (onward p q) (turn_by p u) = turn_by q u.
Proof.
  intros hp hq. rewrite turn_by_after, after_onward; [now apply turn_by_longer | | exact hp].
  rewrite square_of_onward. now apply Rmult_integral_contrapositive.
Qed.

(** A quaternion turns by twice the angle whose tangent is its vector part by its scalar part. *)
Lemma turn_about_is_turn_by q u : scalar_part q <> 0 ->
  turn_about (unit_along (vector_part q)) (2 * atan (norm (vector_part q) / scalar_part q)) u = turn_by q u.
Proof.
  destruct q as [v w]. cbn [vector_part scalar_part]. intros h.
  assert (pos := square_is_positive (Quaternion v w) h). unfold square in pos. cbn [vector_part scalar_part] in pos.
  assert (s : dot v v = norm v * norm v) by apply dot_is_square.
  assert (one : 1 + (norm v / w) * (norm v / w) = (dot v v + w * w) / (w * w)) by (rewrite s; now field).
  assert (ww : 0 < w * w) by (apply Rsqr_pos_lt in h; exact h).
  assert (root : sqrt (1 + (norm v / w) * (norm v / w)) * sqrt (1 + (norm v / w) * (norm v / w)) = (dot v v + w * w) /
    (w * w)).
  { rewrite sqrt_sqrt; [exact one |]. rewrite one. left. apply Rdiv_lt_0_compat; lra. }
  assert (nz : sqrt (1 + (norm v / w) * (norm v / w)) <> 0).
  { intros z. rewrite z, Rmult_0_l in root. assert (0 < (dot v v + w * w) / (w * w)) by (apply Rdiv_lt_0_compat; lra).
    lra. }
  assert (c : cos (2 * atan (norm v / w)) = (w * w - dot v v) / (dot v v + w * w)).
  { rewrite cos_2a, cos_atan, sin_atan. unfold Rsqr.
    set (r := sqrt (1 + norm v / w * (norm v / w))) in *.
    replace (1 / r * (1 / r) - norm v / w / r * (norm v / w / r)) with
      ((1 - norm v / w * (norm v / w)) / (r * r)) by (field; split; assumption).
    rewrite root, s. field. rewrite s in pos. split; [lra | exact h]. }
  assert (sn : sin (2 * atan (norm v / w)) = 2 * w * norm v / (dot v v + w * w)).
  { rewrite sin_2a, cos_atan, sin_atan. unfold Rsqr.
    set (r := sqrt (1 + norm v / w * (norm v / w))) in *.
    replace (2 * (norm v / w / r) * (1 / r)) with (2 * (norm v / w) / (r * r)) by (field; split; assumption).
    rewrite root, s. field. rewrite s in pos. split; [lra | exact h]. }
  unfold turn_about, turn_by, unit_along. rewrite c, sn. cbn [vector_part scalar_part].
  destruct (Req_dec (norm v) 0) as [z | n].
  - assert (v0 : v = Vec 0 0 0) by (apply norm_is_zero; lra). rewrite z, s, z. subst v. destruct u as [x y t].
    unfold plus, times, cross, dot. cbn [vx vy vz].
    generalize (/ 0). intros k. f_equal; field; lra || (repeat split; nra).
  - rewrite s in *. destruct u as [x y t]. destruct v as [a b d]. set (N := norm (Vec a b d)) in *.
    unfold plus, times, cross, dot. cbn [vx vy vz]. f_equal; field; split; lra.
Qed.

(** A geodesic leads to its second pose. *)
Lemma geodesic_arrives v w u : scalar_part (between (quaternion_of v) (quaternion_of w)) <> 0 ->
  turn (on_geodesic v w 1) u = turn_by (quaternion_of w) u.
Proof.
  intros h. destruct (squares_are_not_0 _ _ h) as [hp hq]. unfold on_geodesic. cbn [turn].
  rewrite Rmult_1_l, turn_about_is_turn_by by exact h. now apply turn_by_between.
Qed.
