(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Lemmas over the real numbers, on which a proof of soundness can rest *)

From Coq Require Import Reals List Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
From Taut Require Import Statement Certificate.
Open Scope R_scope.

(** ** Slopes

    What changes is the place s on a segment, from m, and where a machine deviates, by a vector in each of some balls.
    Below, [f] is a quantity at m of the machine as stated, and [f'] at s of one that deviates; t is the change. *)

Record change := Change { of_place : R; of_ball : nat -> vec R }.

Fixpoint sum_over (n : nat) (f : nat -> R) : R :=
  match n with O => 0 | S n => f 0%nat + sum_over n (fun b => f (S b)) end.

(** How much a change with the slopes k makes. *)
Definition moved (k t : change) : R :=
  of_place k * of_place t + sum_over balls (fun b => dot (of_ball k b) (of_ball t b)).
Definition k_plus (k l : change) := Change (of_place k + of_place l) (fun b => plus (of_ball k b) (of_ball l b)).
Definition k_times (c : R) (k : change) := Change (c * of_place k) (fun b => times c (of_ball k b)).
Definition k_place (c : R) := Change c (fun _ => Vec 0 0 0).
Definition is_still (t : change) : Prop := of_place t = 0 /\ forall b, (b < balls)%nat -> of_ball t b = Vec 0 0 0.

Lemma sum_over_plus n f g : sum_over n (fun b => f b + g b) = sum_over n f + sum_over n g.
Proof. revert f g. induction n as [| n IH]; intros f g; cbn; [ring |]. rewrite IH. ring. Qed.

Lemma sum_over_times n c f : sum_over n (fun b => c * f b) = c * sum_over n f.
Proof. revert f. induction n as [| n IH]; intros f; cbn; [ring |]. rewrite IH. ring. Qed.

Lemma sum_over_same n f g : (forall b, (b < n)%nat -> f b = g b) -> sum_over n f = sum_over n g.
Proof.
  revert f g. induction n as [| n IH]; intros f g h; cbn; [reflexivity |].
  rewrite (h 0%nat), (IH _ (fun b => g (S b))); [reflexivity | | lia]. intros b l. apply h. lia.
Qed.

Lemma sum_over_zeros n : sum_over n (fun _ => 0) = 0.
Proof. induction n as [| n IH]; cbn; [reflexivity | rewrite IH; ring]. Qed.

Lemma dot_plus_left u v w : dot (plus u v) w = dot u w + dot v w.
Proof. destruct u, v, w. unfold dot, plus. cbn. ring. Qed.

Lemma dot_times_left c u w : dot (times c u) w = c * dot u w.
Proof. destruct u, w. unfold dot, times. cbn. ring. Qed.

Lemma dot_zero_left w : dot (Vec 0 0 0) w = 0.
Proof. destruct w. unfold dot. cbn. ring. Qed.

Lemma sum_over_one n i c e : (i < n)%nat ->
  sum_over n (fun b => dot (if Nat.eqb b i then c else Vec 0 0 0) (e b)) = dot c (e i).
Proof.
  revert i e. induction n as [| n IH]; intros i e l; [lia |]. cbn [sum_over]. destruct i as [| i].
  - cbn [Nat.eqb]. rewrite (sum_over_same _ _ (fun _ => 0)), sum_over_zeros; [ring |]. intros. apply dot_zero_left.
  - cbn [Nat.eqb]. rewrite dot_zero_left, (IH i (fun b => e (S b))) by lia. ring.
Qed.

Lemma moved_plus k l t : moved (k_plus k l) t = moved k t + moved l t.
Proof.
  unfold moved, k_plus. cbn [of_place of_ball]. rewrite (sum_over_same _ _
    (fun b => dot (of_ball k b) (of_ball t b) + dot (of_ball l b) (of_ball t b))) by (intros; apply dot_plus_left).
  rewrite sum_over_plus. ring.
Qed.

Lemma moved_times c k t : moved (k_times c k) t = c * moved k t.
Proof.
  unfold moved, k_times. cbn [of_place of_ball]. rewrite (sum_over_same _ _
    (fun b => c * dot (of_ball k b) (of_ball t b))) by (intros; apply dot_times_left).
  rewrite sum_over_times. ring.
Qed.

Lemma moved_place c t : moved (k_place c) t = c * of_place t.
Proof.
  unfold moved, k_place. cbn [of_place of_ball].
  rewrite (sum_over_same _ _ (fun _ => 0)) by (intros; apply dot_zero_left). rewrite sum_over_zeros. ring.
Qed.

Lemma moved_still k t : is_still t -> moved k t = 0.
Proof.
  intros [p h]. unfold moved. rewrite p.
  rewrite (sum_over_same _ _ (fun _ => 0)), sum_over_zeros; [ring |]. intros b l. rewrite (h b l).
  destruct (of_ball k b). unfold dot. cbn. ring.
Qed.

Definition sloped (k t : change) (f f' : R) : Prop := f' = f + moved k t.

(** A slope there always is, but where the quantity changes and nothing else does. *)
Lemma has_slope t q q' : (is_still t -> q' = q) -> exists k, sloped k t q q'.
Proof.
  intros h. destruct (Req_dec (moved t t) 0) as [z | n].
  - exists (k_place 0). unfold sloped. rewrite moved_place, h; [ring |].
    assert (square : forall u, 0 <= dot u u) by (intros [x y w]; unfold dot; cbn; nra).
    assert (p : forall n f, (forall b, 0 <= f b) -> 0 <= sum_over n f /\
        (sum_over n f = 0 -> forall b, (b < n)%nat -> f b = 0)).
    { induction n as [| n IH]; intros f pos; cbn; [split; [lra | intros _ b l; lia] |].
      destruct (IH (fun b => f (S b)) (fun b => pos (S b))) as [s e]. assert (p0 := pos 0%nat). split; [lra |].
      intros zero b l. destruct b as [| b]; [lra |]. apply (e ltac:(lra) b). lia. }
    destruct (p balls (fun b => dot (of_ball t b) (of_ball t b)) (fun b => square _)) as [s e].
    unfold moved in z. assert (q0 := Rle_0_sqr (of_place t)). unfold Rsqr in q0. split; [nra |].
    intros b l. assert (d := e ltac:(nra) b l). cbn beta in d. destruct (of_ball t b) as [x y w]. unfold dot in d.
      cbn in d.
    f_equal; nra.
  - exists (k_times ((q' - q) / moved t t) t). unfold sloped. rewrite moved_times. now field.
Qed.

Lemma sloped_plus k l t f f' g g' : sloped k t f f' -> sloped l t g g' -> sloped (k_plus k l) t (f + g) (f' + g').
Proof. unfold sloped; rewrite moved_plus; intros -> ->; ring. Qed.

Lemma sloped_minus k t f f' : sloped k t f f' -> sloped (k_times (- 1) k) t (- f) (- f').
Proof. unfold sloped; rewrite moved_times; intros ->; ring. Qed.

Lemma sloped_times k l t f f' g g' :
  sloped k t f f' -> sloped l t g g' -> sloped (k_plus (k_times g' k) (k_times f l)) t (f * g) (f' * g').
Proof. unfold sloped; rewrite moved_plus, !moved_times; intros -> ->; ring. Qed.

Lemma sloped_over k l t f f' g g' : g <> 0 -> g' <> 0 -> sloped k t f f' -> sloped l t g g' ->
  sloped (k_times (/ g') (k_plus k (k_times (- 1) (k_times (f / g) l)))) t (f / g) (f' / g').
Proof. unfold sloped; rewrite moved_times, moved_plus, !moved_times; intros a b -> H; rewrite H in *; field; auto. Qed.

Lemma sloped_sqrt k t f f' : 0 <= f -> 0 < f' ->
  sloped k t f f' -> sloped (k_times (/ (sqrt f + sqrt f')) k) t (sqrt f) (sqrt f').
Proof.
  unfold sloped; rewrite moved_times; intros a b H.
  assert (p := sqrt_pos f). assert (q := sqrt_lt_R0 f' b).
  assert (r := sqrt_sqrt f a). assert (s := sqrt_sqrt f' (Rlt_le _ _ b)).
  apply Rmult_eq_reg_r with (sqrt f + sqrt f'); [|lra].
  replace ((sqrt f + / (sqrt f + sqrt f') * moved k t) * (sqrt f + sqrt f'))
    with (sqrt f * (sqrt f + sqrt f') + moved k t) by (field; lra).
  replace (moved k t) with (f' - f) by lra. nra.
Qed.

Lemma sin_between f f' : exists x, Rmin f f' <= x <= Rmax f f' /\ sin f' = sin f + cos x * (f' - f).
Proof.
  destruct (MVT_gen sin f f' cos) as [x [r e]].
  - intros x _; auto_derive; [exact I | ring].
  - intros x _; apply continuity_sin.
  - exists x; split; [exact r | lra].
Qed.

Lemma cos_between f f' : exists x, Rmin f f' <= x <= Rmax f f' /\ cos f' = cos f + - sin x * (f' - f).
Proof.
  destruct (MVT_gen cos f f' (fun x => - sin x)) as [x [r e]].
  - intros x _; auto_derive; [exact I | ring].
  - intros x _; apply continuity_cos.
  - exists x; split; [exact r | lra].
Qed.

Lemma sloped_sin k t f f' : sloped k t f f' ->
  exists x, Rmin f f' <= x <= Rmax f f' /\ sloped (k_times (cos x) k) t (sin f) (sin f').
Proof.
  unfold sloped; intros H. destruct (sin_between f f') as [x [r e]].
  exists x; split; [exact r |]. rewrite moved_times, e, H. ring.
Qed.

Lemma sloped_cos k t f f' : sloped k t f f' ->
  exists x, Rmin f f' <= x <= Rmax f f' /\ sloped (k_times (- sin x) k) t (cos f) (cos f').
Proof.
  unfold sloped; intros H. destruct (cos_between f f') as [x [r e]].
  exists x; split; [exact r |]. rewrite moved_times, e, H. ring.
Qed.

(** ** The range of a linear function over an ellipsoid, whose form is a sum of squares: Cauchy and Schwarz

    Of the coordinates z, z1 first, a square is (a, k): a (z1 + k.z')^2, where z' are those that come after. *)

Fixpoint lin (k z : list R) : R := match k, z with x :: k, y :: z => x * y + lin k z | _, _ => 0 end.
Fixpoint less (y k : list R) : list R :=
  match y, k with
  | y, nil => y
  | nil, x :: k => - x :: less nil k
  | y1 :: y, x :: k => y1 - x :: less y k
  end.

Fixpoint form (l : list (R * list R)) (z : list R) : R :=
  match l, z with (a, k) :: l, x :: z => a * ((x + lin k z) * (x + lin k z)) + form l z | _, _ => 0 end.
Fixpoint spread (l : list (R * list R)) (y : list R) : R :=
  match l, y with (a, k) :: l, c :: y => c * c / a + spread l (less y (map (Rmult c) k)) | _, _ => 0 end.

Definition positive (l : list (R * list R)) : Prop := List.Forall (fun a => 0 < fst a) l.

Lemma lin_of_nothing z : lin nil z = 0.
Proof. now destruct z. Qed.

Lemma lin_of_less y k z : lin (less y k) z = lin y z - lin k z.
Proof.
  revert k z. induction y as [| y1 y IH]; intros k z.
  - revert z. induction k as [| x k IHk]; intros z; [cbn [less]; rewrite !lin_of_nothing; ring |].
    destruct z as [| z1 z]; cbn [less lin]; [ring |]. rewrite IHk, lin_of_nothing. ring.
  - destruct k as [| x k]; [cbn [less]; rewrite !lin_of_nothing; ring |].
    destruct z as [| z1 z]; cbn [less lin]; [ring |]. rewrite IH. ring.
Qed.

Lemma lin_of_times c k z : lin (map (Rmult c) k) z = c * lin k z.
Proof.
  revert z. induction k as [| x k IH]; intros z; [cbn [map]; rewrite !lin_of_nothing; ring |].
  destruct z as [| z1 z]; cbn [map lin]; [ring |]. rewrite IH. ring.
Qed.

Lemma cauchy_schwarz l : positive l -> forall y z, (List.length z <= List.length l)%nat ->
  0 <= spread l y /\ 0 <= form l z /\ lin y z * lin y z <= spread l y * form l z.
Proof.
  induction 1 as [| [a k] l pos _ IH]; intros y z len.
  - destruct z; [| cbn in len; lia]. destruct y; cbn; lra.
  - cbn [fst] in pos. destruct y as [| c y].
    + destruct z as [| x z]; cbn [spread form lin]; [lra |].
      destruct (IH nil z ltac:(cbn in len; lia)) as [_ [h _]]. assert (0 <= (x + lin k z) * (x + lin k z)) by apply
        Rle_0_sqr.
      assert (0 <= a * ((x + lin k z) * (x + lin k z))) by (apply Rmult_le_pos; lra). lra.
    + assert (u : 0 <= c * c / a) by (apply Rmult_le_pos; [nra | left; now apply Rinv_0_lt_compat]).
      destruct z as [| x z].
      { cbn [spread form lin]. destruct (IH (less y (map (Rmult c) k)) nil ltac:(cbn; lia)) as [h [_ _]]. lra. }
      cbn [spread form lin]. destruct (IH (less y (map (Rmult c) k)) z ltac:(cbn in len; lia)) as [hA [hB h]].
      rewrite lin_of_less, lin_of_times in h.
      set (A := spread l (less y (map (Rmult c) k))) in *. set (B := form l z) in *.
      set (S := lin y z - c * lin k z) in *. set (w := x + lin k z).
      assert (v : 0 <= a * (w * w)) by (assert (0 <= w * w) by apply Rle_0_sqr; nra).
      split; [lra |]. split; [lra |].
      set (X := A * (a * (w * w))). set (Y := B * (c * c / a)).
      assert (hx : 0 <= X) by (apply Rmult_le_pos; lra). assert (hy : 0 <= Y) by (apply Rmult_le_pos; lra).
      assert (xy : X * Y = A * B * ((c * w) * (c * w))) by (unfold X, Y; field; lra).
      assert (sw : S * S * ((c * w) * (c * w)) <= X * Y)
        by (rewrite xy; apply Rmult_le_compat_r; [apply Rle_0_sqr | exact h]).
      assert (m : 2 * S * (c * w) <= X + Y).
      { apply Rnot_lt_le; intro n. assert (0 <= (X - Y) * (X - Y)) by apply Rle_0_sqr.
        assert ((X + Y) * (X + Y) < (2 * S * (c * w)) * (2 * S * (c * w))) by (apply Rmult_le_0_lt_compat; lra). nra. }
      replace (c * x + lin y z) with (c * w + S) by (unfold w, S; ring).
      replace ((c * c / a + A) * (a * (w * w) + B)) with (c * c * (w * w) + X + Y + A * B)
        by (unfold X, Y; field; lra).
      nra.
Qed.

Theorem range_of_ellipsoid l y z : positive l -> (List.length z <= List.length l)%nat -> form l z <= 1 ->
  Rabs (lin y z) <= sqrt (spread l y).
Proof.
  intros p len q; destruct (cauchy_schwarz l p y z len) as [a [b h]].
  rewrite <- sqrt_Rsqr_abs; apply sqrt_le_1_alt; unfold Rsqr; nra.
Qed.

(** The form of a matrix, by rows. *)
Fixpoint quad (rows : list (list R)) (z w : list R) : R :=
  match rows, z with row :: rows, x :: z => x * lin row w + quad rows z w | _, _ => 0 end.

Lemma quad_peeled rows z x w :
  quad rows z (x :: w) = x * lin (map (hd 0) rows) z + quad (map (@tl R) rows) z w.
Proof.
  revert z. induction rows as [| row rows IH]; intros z; [cbn [quad map]; rewrite lin_of_nothing; ring |].
  destruct z as [| z1 z]; cbn [quad map lin]; [ring |]. rewrite IH.
  destruct row as [| b s]; cbn [hd tl lin]; ring.
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
