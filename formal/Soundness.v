(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What the checker accepts is true *)

From Coq Require Import Reals QArith Qreals ZArith Lra Lia Bool List FunctionalExtensionality.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate Lemmas Loads Turns Checker Enclosure Machine Contraction Poses Motions
  Tubes.
Import ListNotations.
Open Scope R_scope.

(** ** Where segments meet *)

Lemma lines_meet v w x : on_line v w 1 = on_line w x 0.
Proof. apply functional_extensionality. intros i. unfold on_line. ring. Qed.

Lemma splines_meet a b c d e : on_spline a b c d 1 = on_spline b c d e 0.
Proof. apply functional_extensionality. intros i. unfold on_spline. field. Qed.

Lemma chords_meet v w x : on_chord v w 1 = on_chord w x 0.
Proof. unfold on_chord. now rewrite (lines_meet v w x). Qed.

Lemma geodesics_meet v w x : scalar_part (between (quaternion_of v) (quaternion_of w)) <> 0 ->
  on_geodesic v w 1 = on_geodesic w x 0.
Proof.
  intros h. assert (arrives := geodesic_arrives v w). unfold on_geodesic in *. cbn [turn] in *.
  rewrite (lines_meet v w x). f_equal. apply functional_extensionality. intros u.
  rewrite (arrives u h), Rmult_0_l, turn_about_by_nothing. reflexivity.
Qed.

(** A tube around a pose is in another. *)
Lemma smaller_tube v w P P' : 0 <= coordinate v 13 <= coordinate w 13 -> 0 <= coordinate v 14 <= coordinate w 14 ->
  0 < coordinate w 13 -> 0 < coordinate w 14 -> in_tube v P P' -> in_tube w P P'.
Proof.
  intros [a b] [d e] pos pos' [y [z [hy [hz ->]]]].
  assert (scaled : forall r q u, 0 <= r <= q -> 0 < q -> in_unit_box u ->
    in_unit_box (times (r / q) u) /\ times q (times (r / q) u) = times r u).
  { intros r q [x1 x2 x3] [lo hi] hq [h1 [h2 h3]]. cbn [vx vy vz] in *.
    assert (f : 0 <= r / q <= 1).
    { split; [apply Rmult_le_pos; [exact lo | left; now apply Rinv_0_lt_compat] |].
      apply Rmult_le_reg_r with q; [exact hq |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    assert (one : forall x, Rabs x <= 1 -> Rabs (r / q * x) <= 1).
    { intros x h. rewrite Rabs_mult, (Rabs_pos_eq (r / q)) by lra. assert (p := Rabs_pos x). nra. }
    split; [split; [| split]; cbn; now apply one |]. unfold times. cbn [vx vy vz]. f_equal; field; lra. }
  destruct (scaled _ _ y (conj a b) pos hy) as [by_ ey]. destruct (scaled _ _ z (conj d e) pos' hz) as [bz ez].
  exists (times (coordinate v 13 / coordinate w 13) y), (times (coordinate v 14 / coordinate w 14) z).
  split; [exact by_ | split; [exact bz |]]. now rewrite ey, ez.
Qed.

Module Soundness (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module T := Tubes.Tubes F.
Import T T.M T.M.P T.M.P.N T.M.P.N.C.

Section Certificate.

Variable c : certificate.
Let prec := F.PtoP (bits c).
Let m := subject c.
Hypothesis turns_little : below prec (angle_of prec m) (one prec) = true.

(** What is claimed of a place. *)
Definition holds (q : R -> pose -> Prop) (s : R) : Prop :=
  exists P, q s P /\ (forall P', q s P' -> P' = P) /\
  forall b P', is_built m b -> is_tracked m P P' -> feasible_at m b (tension_margin c) (length_margin c) P'.

(** A motion, and what the checker has of it. *)
Definition matches (f : motion_form) (q : R -> pose -> Prop) : Prop :=
  match f with
  | Explicit p => exists P : R -> pose, follows p P /\ q = (fun s => eq (P s))
  | Held v w => q = held m v w
  end.

Lemma motions_match l path : Forall2 matches (motions prec m l path) (segments m l path).
Proof.
  induction path as [| v path IH]; [constructor |].
  destruct l; cbn [motions segments].
  - destruct path as [| w path]; [constructor |]. constructor; [| exact IH].
    eexists. split; [apply posed_follows, line_follows | reflexivity].
  - destruct path as [| b [| d [| e path]]]; try constructor; [| exact IH].
    eexists. split; [apply posed_follows, spline_follows | reflexivity].
  - destruct path as [| w path]; [constructor |]. constructor; [| exact IH].
    eexists. split; [apply geodesic_follows | reflexivity].
  - destruct path as [| w path]; [constructor |]. constructor; [reflexivity | exact IH].
Qed.

Lemma box_is_sound f q start b : matches f q -> check_box prec c f start b = true ->
  forall s, Q2R start <= s <= Q2R (upto b) -> holds q s.
Proof.
  intros h hb s hs. destruct f as [p | v w].
  - destruct h as [P [follow ->]]. unfold check_box in hb. rewrite andb_true_iff in hb. destruct hb as [_ hb].
    exists (P s). split; [reflexivity | split; [now intros P' -> |]].
    exact (poses_are_sound prec c m p P turns_little follow start b hb s hs).
  - unfold matches in h. subst q. exact (held_box_is_sound prec c v w start b hb s hs).
Qed.

Lemma boxes_are_sound f q : matches f q -> forall l start, check_boxes prec c f start l = true ->
  forall s, Q2R start <= s <= 1 -> holds q s.
Proof.
  intros match_q. induction l as [| b l IH]; intros start h s [x y]; [discriminate h |].
  destruct l as [| b' l].
  - cbn [check_boxes] in h. rewrite andb_true_iff in h. destruct h as [e h].
    apply (box_is_sound f q start b match_q h). split; [exact x |].
    apply Qeq_bool_eq, Qeq_eqR in e. rewrite e. unfold Q2R. cbn. lra.
  - change (check_box prec c f start b && check_boxes prec c f (upto b) (b' :: l) = true) in h.
    rewrite andb_true_iff in h. destruct h as [h h'].
    destruct (Rle_dec s (Q2R (upto b))) as [le | gt].
    + apply (box_is_sound f q start b match_q h). lra.
    + apply (IH (upto b) h'). lra.
Qed.

Lemma motions_are_sound fs qs : Forall2 matches fs qs -> forall l, check_motions prec c fs l = true ->
  Forall (fun q : R -> pose -> Prop => forall s, 0 <= s <= 1 -> holds q s) qs.
Proof.
  induction 1 as [| f q fs qs fq _ IH]; intros l h; [constructor |].
  destruct l as [| b l]; [discriminate h |].
  cbn [check_motions] in h. rewrite andb_true_iff in h. destruct h as [h h'].
  constructor; [| exact (IH l h')].
  intros s [x y]. apply (boxes_are_sound f q fq b 0 h). split; [| exact y]. unfold Q2R. cbn. lra.
Qed.

(** ** Segments are joined *)

Lemma a_tube_has_a_size v w l : check_boxes prec c (Held v w) 0 l = true ->
  no_half_turns v = true /\ 0 < coordinate v 13 /\ 0 < coordinate v 14.
Proof.
  intros h. assert (b : exists b, check_box prec c (Held v w) 0 b = true).
  { destruct l as [| b [| b' l]]; [discriminate h | |]; exists b; cbn [check_boxes] in h; rewrite andb_true_iff in h;
    tauto. }
  destruct b as [b hb]. unfold check_box in hb. rewrite andb_true_iff in hb. destruct hb as [_ hb].
  destruct (tube b) as [k |]; [| discriminate hb]. cbv zeta in hb. rewrite !andb_true_iff in hb.
  destruct hb as [[[[[_ t] _] _] _] _]. unfold has_tube in t. rewrite !andb_true_iff in t. destruct t as [[[r p] q] _].
  rewrite !(without_half_turns v) by exact r. split; [exact r | split; now apply above_zero_of].
Qed.

Lemma nested v w : no_half_turns v = true -> no_half_turns w = true -> contains_tube v w = true ->
  coordinate w 13 <= coordinate v 13 /\ coordinate w 14 <= coordinate v 14.
Proof.
  intros hv hw. unfold contains_tube. rewrite andb_true_iff, !(without_half_turns v),
    !(without_half_turns w) by assumption.
  intros [a b]. apply Qle_bool_iff, Qle_Rle in a. apply Qle_bool_iff, Qle_Rle in b. now split.
Qed.

Lemma tubes_meet v w x P : no_half_turns v = true -> no_half_turns w = true -> tubes_nest v w = true ->
  0 < coordinate v 13 /\ 0 < coordinate v 14 -> 0 < coordinate w 13 /\ 0 < coordinate w 14 ->
  holds (held m v w) 1 -> holds (held m w x) 0 -> held m v w 1 P -> held m w x 0 P.
Proof.
  intros hv hw nest [pv qv] [pw qw] [Pv [_ [only _]]] [Pw [is _]] [inside lengths]. unfold held in *.
  rewrite <- (chords_meet v w x), <- (lines_meet v w x) in *.
  unfold tubes_nest in nest. rewrite orb_true_iff in nest. destruct nest as [n | n].
  - destruct (nested v w hv hw n) as [a b]. destruct is as [inside' lengths'].
    assert (inside_v : in_tube v (on_chord v w 1) Pw) by (apply (smaller_tube w v); try assumption; lra).
    replace P with Pw; [now split |]. rewrite (only P) by (now split). now apply only.
  - destruct (nested w v hw hv n) as [a b]. split; [| exact lengths]. apply (smaller_tube v w); try assumption; lra.
Qed.

Lemma segments_are_joined l : forall path boxes, is_joined l path = true ->
  check_motions prec c (motions prec m l path) boxes = true -> joined (segments m l path).
Proof.
  induction path as [| v path IH]; intros boxes pairwise h; [exact I |].
  destruct l.
  - destruct path as [| w [| x path]]; try exact I. destruct boxes as [| b boxes]; [discriminate h |].
    cbn [motions check_motions] in h. rewrite andb_true_iff in h. destruct h as [_ h].
    split; [| exact (IH boxes eq_refl h)]. intros P. now rewrite (lines_meet v w x).
  - destruct path as [| b' [| d [| e [| e' path]]]]; try exact I. destruct boxes as [| b boxes]; [discriminate h |].
    cbn [motions check_motions] in h. rewrite andb_true_iff in h. destruct h as [_ h].
    split; [| exact (IH boxes eq_refl h)]. intros P. now rewrite (splines_meet v b' d e e').
  - destruct path as [| w [| x path]]; try exact I. destruct boxes as [| b boxes]; [discriminate h |].
    cbn [motions check_motions] in h. rewrite andb_true_iff in h. destruct h as [_ h].
    cbn [is_joined pairs] in pairwise. rewrite andb_true_iff in pairwise. destruct pairwise as [meet pairwise].
    split; [| exact (IH boxes pairwise h)]. intros P. rewrite (geodesics_meet v w x); [trivial |].
    unfold turns_meet in meet. rewrite !andb_true_iff, negb_true_iff in meet. destruct meet as [[hv hw] hc].
    rewrite (between_is_rational v w hv hw). cbn [scalar_part]. intros z.
    assert (e : Qeq_bool (snd (between_q v w)) 0 = true); [| congruence].
    apply Qeq_bool_iff, eqR_Qeq. rewrite z. unfold Q2R. cbn. lra.
  - destruct path as [| w [| x path]]; try exact I.
    assert (all := motions_are_sound _ _ (motions_match Lengths (v :: w :: x :: path)) _ h).
    destruct boxes as [| b [| b' boxes]]; [discriminate h | cbn [motions check_motions] in h;
      rewrite andb_false_r in h; discriminate h |].
    cbn [motions check_motions] in h. rewrite !andb_true_iff in h. destruct h as [h [h' h'']].
    cbn [is_joined pairs] in pairwise. rewrite andb_true_iff in pairwise. destruct pairwise as [nest pairwise].
    split.
    + intros P. inversion all as [| q qs first rest]; subst. inversion rest as [| q qs second _]; subst.
      destruct (a_tube_has_a_size v w b h) as [hv pv]. destruct (a_tube_has_a_size w x b' h') as [hw pw].
      apply tubes_meet; try assumption.
      * apply first; lra.
      * apply second; lra.
    + apply (IH (b' :: boxes) pairwise). cbn [motions check_motions]. now rewrite h', h''.
Qed.

End Certificate.

Definition check : certificate -> bool := C.check.

(** What the checker accepts is true. *)
Theorem check_sound c : check c = true -> statement c.
Proof.
  unfold check, C.check. cbv zeta. rewrite !andb_true_iff. intros [[[many join] little] h].
  assert (all := motions_match c (motion c) (path c)).
  split; [| split].
  - destruct all; [discriminate many | discriminate].
  - exact (segments_are_joined c little (motion c) (path c) (boxes c) join h).
  - exact (motions_are_sound c little _ _ all (boxes c) h).
Qed.

End Soundness.
