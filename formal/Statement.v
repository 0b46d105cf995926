(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What it means that a path of a cable-driven hexapod is wrench-feasible

    This file is the whole statement: definitions over the real numbers, and no word of how they are proved.
    Lengths are in metres, angles in radians, forces in newtons, moments in newton metres. *)

From Coq Require Import Reals QArith Qreals List.
Open Scope R_scope.

(** The data are rational numbers, and stand for themselves. *)
Coercion Q2R : Q >-> R.

(** ** Vectors and wrenches *)

Record vec (A : Type) := Vec { vx : A; vy : A; vz : A }.
Arguments Vec {A}. Arguments vx {A}. Arguments vy {A}. Arguments vz {A}.

Definition real_vec (v : vec Q) : vec R := Vec (Q2R (vx v)) (Q2R (vy v)) (Q2R (vz v)).
Definition plus (u v : vec R) := Vec (vx u + vx v) (vy u + vy v) (vz u + vz v).
Definition minus (u v : vec R) := Vec (vx u - vx v) (vy u - vy v) (vz u - vz v).
Definition times (k : R) (v : vec R) := Vec (k * vx v) (k * vy v) (k * vz v).
Definition dot (u v : vec R) := vx u * vx v + vy u * vy v + vz u * vz v.
Definition norm (v : vec R) := sqrt (dot v v).
Definition cross (u v : vec R) :=
  Vec (vy u * vz v - vz u * vy v) (vz u * vx v - vx u * vz v) (vx u * vy v - vy u * vx v).

(** A wrench is a force and a moment about the load point, both in the axes of the world. *)
Record wrench := Wrench { force : vec R; moment : vec R }.
Definition wrench_plus (v w : wrench) := Wrench (plus (force v) (force w)) (plus (moment v) (moment w)).
Definition wrench_times (k : R) (w : wrench) := Wrench (times k (force w)) (times k (moment w)).

(** ** The machine *)

(** Six of something, one a cable. *)
Record six (A : Type) := Six { at1 : A; at2 : A; at3 : A; at4 : A; at5 : A; at6 : A }.
Arguments Six {A}.
Arguments at1 {A}. Arguments at2 {A}. Arguments at3 {A}. Arguments at4 {A}. Arguments at5 {A}. Arguments at6 {A}.

Definition map6 {A B : Type} (f : A -> B) (a : six A) : six B :=
  Six (f (at1 a)) (f (at2 a)) (f (at3 a)) (f (at4 a)) (f (at5 a)) (f (at6 a)).
Definition zip6 {A B C : Type} (f : A -> B -> C) (a : six A) (b : six B) : six C :=
  Six (f (at1 a) (at1 b)) (f (at2 a) (at2 b)) (f (at3 a) (at3 b))
      (f (at4 a) (at4 b)) (f (at5 a) (at5 b)) (f (at6 a) (at6 b)).
Definition fold6 {A : Type} (f : A -> A -> A) (a : six A) : A :=
  f (f (f (f (f (at1 a) (at2 a)) (at3 a)) (at4 a)) (at5 a)) (at6 a).
Definition all6 : six Prop -> Prop := fold6 and.
Definition sum6 : six R -> R := fold6 Rplus.

(** A cable runs from [base], a point of the world, to [platform], a point in the platform's axes. Its tension and its
    length have to stay strictly between two limits each. *)
Record cable := Cable { base : vec Q; platform : vec Q; tension : Q * Q; length : Q * Q }.

(** Sets of vectors, forces or moments: all up to a magnitude; those of them at right angles to [normal]; and f times
    the unit vector along [direction], for every f from [lower] to [upper]. *)
Inductive vectors := Ball (radius : Q) | Disc (radius : Q) (normal : vec Q)
  | Along (direction : vec Q) (lower upper : Q).

(** The axes in which vectors are stated. *)
Inductive axes := OfWorld | OfPlatform.

(** The load is a sum of sets of wrenches. An ellipsoid is the set of all w with (w - c)' shape (w - c) <= 1, where c is
    [center] plus any share of [shift] from -1 to 1; its six coordinates are force and moment. A weight has any mass
    from [lower] to [upper], and its centre of gravity anywhere within [tolerance] of [point], a point in the platform's
    axes. Forces act at such a point. Load cases are wrenches, force and moment about such a point, and all that are
    between them. *)
Inductive item :=
  | Ellipsoid (center shift : six Q) (shape : six (six Q))
  | Weight (lower upper : Q) (gravity : vec Q) (point : vec Q) (tolerance : Q)
  | Force (set : vectors) (a : axes) (point : vec Q)
  | Moment (set : vectors) (a : axes)
  | LoadCases (cases : list (vec Q * vec Q)) (a : axes) (point : vec Q).

(** The pose is given by expressions of the parameters; parameters are counted from 0. *)
Inductive expr :=
  | Number (q : Q) | Pi | Param (i : nat)
  | Minus (e : expr) | Plus (d e : expr) | Sub (d e : expr) | Times (d e : expr) | Over (d e : expr)
  | Sqrt (e : expr) | Sin (e : expr) | Cos (e : expr).

Inductive angles := TiltTorsion (phi theta sigma : expr) | RollPitchYaw (roll pitch yaw : expr)
  | Zyz (alpha beta gamma : expr) | About (axis : vec Q) (angle : expr).

(** How far a machine may be from what is stated, in any direction: each cable's two anchors, and the load point; and
    how far the platform may be from where it is meant to be, and by what angle turned: an expression without
    parameters, of which only the magnitude counts. *)
Record tolerances := Tolerances { of_anchors : six (Q * Q); of_load_point : Q; of_position : Q; of_orientation : expr }.

Record machine := Machine { cables : six cable; load_point : vec Q; load : list item;
                            pose_position : vec expr; pose_angles : angles; tolerance : tolerances }.

(** ** Poses *)

Definition rot_x (t : R) (v : vec R) := Vec (vx v) (cos t * vy v - sin t * vz v) (sin t * vy v + cos t * vz v).
Definition rot_y (t : R) (v : vec R) := Vec (cos t * vx v + sin t * vz v) (vy v) (cos t * vz v - sin t * vx v).
Definition rot_z (t : R) (v : vec R) := Vec (cos t * vx v - sin t * vy v) (sin t * vx v + cos t * vy v) (vz v).

(** Turned about the axis n, a unit vector, by an angle. *)
Definition turn_about (n : vec R) (angle : R) (v : vec R) : vec R :=
  plus (plus (times (cos angle) v) (times (sin angle) (cross n v))) (times ((1 - cos angle) * dot n v) n).
Definition unit_along (v : vec R) : vec R := times (/ norm v) v.

Fixpoint value (p : nat -> R) (e : expr) : R :=
  match e with
  | Number q => q
  | Pi => PI
  | Param i => p i
  | Minus e => - value p e
  | Plus d e => value p d + value p e
  | Sub d e => value p d - value p e
  | Times d e => value p d * value p e
  | Over d e => value p d / value p e
  | Sqrt e => sqrt (value p e)
  | Sin e => sin (value p e)
  | Cos e => cos (value p e)
  end.

(** The platform's origin is at [position], and [turn] takes the platform's axes to those of the world. *)
Record pose := Pose { position : vec R; turn : vec R -> vec R }.

Definition pose_at (m : machine) (p : nat -> R) : pose :=
  let v := value p in
  Pose (Vec (v (vx (pose_position m))) (v (vy (pose_position m))) (v (vz (pose_position m))))
       (fun u => match pose_angles m with
                 | TiltTorsion phi theta sigma => rot_z (v phi) (rot_y (v theta) (rot_z (v sigma - v phi) u))
                 | RollPitchYaw roll pitch yaw => rot_z (v yaw) (rot_y (v pitch) (rot_x (v roll) u))
                 | Zyz alpha beta gamma => rot_z (v alpha) (rot_y (v beta) (rot_z (v gamma) u))
                 | About axis angle => turn_about (unit_along (real_vec axis)) (v angle) u
                 end).

(** ** Tolerances *)

(** A machine as it is built: the anchors of each cable, at the base and in the platform's axes, and the load point. The
    machine itself is exactly as stated. *)
Record built := Built { anchors : six (vec R * vec R); load_at : vec R }.

Definition itself (m : machine) : built :=
  Built (map6 (fun c => (real_vec (base c), real_vec (platform c))) (cables m)) (real_vec (load_point m)).

Definition near (distance : Q) (u : vec R) (v : vec Q) : Prop := norm (minus u (real_vec v)) <= distance.

Definition is_built (m : machine) (b : built) : Prop :=
  let close c t a := near (fst t) (fst a) (base c) /\ near (snd t) (snd a) (platform c) in
  all6 (zip6 (fun close a => close a) (zip6 close (cables m) (of_anchors (tolerance m))) (anchors b)) /\
  near (of_load_point (tolerance m)) (load_at b) (load_point m).

(** Where the platform may be while it is meant to be at P. *)
Definition is_tracked (m : machine) (P P' : pose) : Prop :=
  exists (off n : vec R) (angle : R),
    norm off <= of_position (tolerance m) /\ norm n = 1 /\
    Rabs angle <= Rabs (value (fun _ => 0) (of_orientation (tolerance m))) /\
    P' = Pose (plus (position P) off) (fun v => turn_about n angle (turn P v)).

(** ** Statics *)

(** The vector from a cable's base anchor to its platform anchor. *)
Definition cable_vector (P : pose) (a : vec R * vec R) : vec R := minus (plus (position P) (turn P (snd a))) (fst a).

Definition cable_length (P : pose) (a : vec R * vec R) : R := norm (cable_vector P a).

(** The vector from the load point to a point in the platform's axes, and the wrench of a force that acts there. *)
Definition arm (b : built) (P : pose) (point : vec R) : vec R := turn P (minus point (load_at b)).
Definition force_at (b : built) (P : pose) (point f : vec R) : wrench := Wrench f (cross (arm b P point) f).

(** The wrench that a tension of 1 N of a cable balances: a column of the force Jacobian. *)
Definition column (b : built) (P : pose) (a : vec R * vec R) : wrench :=
  force_at b P (snd a) (times (/ cable_length P a) (cable_vector P a)).

(** The wrench that tensions [f] balance, one number a cable: J f. *)
Definition balanced (b : built) (P : pose) (f : six R) : wrench :=
  fold6 wrench_plus (zip6 (fun a t => wrench_times t (column b P a)) (anchors b) f).

(** The wrenches of the load. *)
Definition six_of (w : wrench) : six R :=
  Six (vx (force w)) (vy (force w)) (vz (force w)) (vx (moment w)) (vy (moment w)) (vz (moment w)).

Definition in_vectors (set : vectors) (v : vec R) : Prop :=
  match set with
  | Ball radius => norm v <= radius
  | Disc radius normal => norm v <= radius /\ dot v (real_vec normal) = 0
  | Along direction lower upper =>
      exists f : R, lower <= f <= upper /\ v = times (f / norm (real_vec direction)) (real_vec direction)
  end.

(** All that are between some wrenches: between the first and one that is between the others. *)
Definition real_wrench (w : vec Q * vec Q) : wrench := Wrench (real_vec (fst w)) (real_vec (snd w)).
Fixpoint in_hull (cases : list (vec Q * vec Q)) (w : wrench) : Prop :=
  match cases with
  | nil => False
  | v :: nil => w = real_wrench v
  | v :: rest => exists (t : R) (u : wrench), 0 <= t <= 1 /\ in_hull rest u /\
      w = wrench_plus (wrench_times t (real_wrench v)) (wrench_times (1 - t) u)
  end.

Definition in_axes (a : axes) (P : pose) (v : vec R) : vec R :=
  match a with OfWorld => v | OfPlatform => turn P v end.
Definition pure_moment (v : vec R) : wrench := Wrench (Vec 0 0 0) v.

Definition in_item (b : built) (P : pose) (i : item) (w : wrench) : Prop :=
  match i with
  | Ellipsoid center shift shape => exists k : R, -1 <= k <= 1 /\
      let z := zip6 Rminus (six_of w) (zip6 (fun c d : Q => c + k * d) center shift) in
      sum6 (zip6 (fun (row : six Q) zi => zi * sum6 (zip6 (fun (e : Q) zj => e * zj) row z)) shape z) <= 1
  | Weight lower upper gravity point tolerance =>
      exists (mass : R) (center : vec R), lower <= mass <= upper /\ norm (minus center (real_vec point)) <= tolerance /\
        w = force_at b P center (times mass (real_vec gravity))
  | Force set a point => exists v, in_vectors set v /\ w = force_at b P (real_vec point) (in_axes a P v)
  | Moment set a => exists v, in_vectors set v /\ w = pure_moment (in_axes a P v)
  | LoadCases cases a point => exists v, in_hull cases v /\
      w = wrench_plus (force_at b P (real_vec point) (in_axes a P (force v))) (pure_moment (in_axes a P (moment v)))
  end.

(** One wrench of each item; the load may depend on the pose. *)
Fixpoint in_items (b : built) (P : pose) (l : list item) (w : wrench) : Prop :=
  match l with
  | nil => w = pure_moment (Vec 0 0 0)
  | i :: l => exists v u, w = wrench_plus v u /\ in_item b P i v /\ in_items b P l u
  end.
Definition in_load (m : machine) (b : built) (P : pose) : wrench -> Prop := in_items b P (load m).

Definition inside (limits : Q * Q) (margin : Q) (t : R) : Prop := fst limits + margin < t < snd limits - margin.

(** All cables have lengths inside their limits; and for every wrench of the load there is exactly one list of tensions
    that balances it, and these are inside their limits. Both by more than a margin, which may be zero. *)
Definition feasible_at (m : machine) (b : built) (tension_margin length_margin : Q) (P : pose) : Prop :=
  all6 (zip6 (fun c a => inside (length c) length_margin (cable_length P a)) (cables m) (anchors b)) /\
  forall w, in_load m b P w ->
    exists f, balanced b P f = w /\ (forall g, balanced b P g = w -> g = f) /\
              all6 (zip6 (fun c t => inside (tension c) tension_margin t) (cables m) f).

(** ** Paths *)

(** A waypoint has a coordinate for each parameter: a number, and half turns (multiples of pi) to be added to it. *)
Definition waypoint := list (Q * Z).
Definition coordinate (w : waypoint) (i : nat) : R := let (q, h) := nth i w (0%Q, 0%Z) in q + IZR h * PI.

(** From each waypoint to the next the path is straight in the parameters. Or its waypoints are the control points of a
    uniform cubic B-spline, which has a segment for any four in a row. Or they are poses, whatever the machine says of
    parameters, and the path turns from each to the next about one axis; or else the lengths of the cables are straight,
    and poses only say near which the platform is. *)
Inductive law := Straight | Spline | Geodesic | Lengths.

Definition on_line (v w : waypoint) (s : R) (i : nat) : R := coordinate v i + s * (coordinate w i - coordinate v i).
Definition on_spline (a b c d : waypoint) (s : R) (i : nat) : R :=
  ((1 - s) ^ 3 * coordinate a i + (3 * s ^ 3 - 6 * s ^ 2 + 4) * coordinate b i +
   (- 3 * s ^ 3 + 3 * s ^ 2 + 3 * s + 1) * coordinate c i + s ^ 3 * coordinate d i) / 6.

(** A quaternion has a vector part and a scalar part, and stands for a turn whatever its length is, but for 0. *)
Record quaternion := Quaternion { vector_part : vec R; scalar_part : R }.

Definition turn_by (q : quaternion) (v : vec R) : vec R :=
  let u := vector_part q in
  let w := scalar_part q in
  times (/ (dot u u + w * w))
    (plus (plus (times (w * w - dot u u) v) (times (2 * dot u v) u)) (times (2 * w) (cross u v))).

(** The turn from one quaternion's axes to those of another, in the former: its conjugate times the other. *)
Definition between (p q : quaternion) : quaternion :=
  Quaternion (minus (minus (times (scalar_part p) (vector_part q)) (times (scalar_part q) (vector_part p)))
                    (cross (vector_part p) (vector_part q)))
             (scalar_part p * scalar_part q + dot (vector_part p) (vector_part q)).

(** The coordinates of a waypoint that is a pose are its position, and a quaternion, vector part first. The position is
    straight and the turn at a constant rate, the shorter way round. At half a turn, where the scalar part is 0, there
    is no shorter one, and the definition divides by 0. *)
Definition quaternion_of (w : waypoint) : quaternion :=
  Quaternion (Vec (coordinate w 3) (coordinate w 4) (coordinate w 5)) (coordinate w 6).
Definition on_geodesic (v w : waypoint) (s : R) : pose :=
  let q := between (quaternion_of v) (quaternion_of w) in
  let angle := 2 * atan (norm (vector_part q) / scalar_part q) in
  Pose (Vec (on_line v w s 0) (on_line v w s 1) (on_line v w s 2))
       (fun u => turn_by (quaternion_of v) (turn_about (unit_along (vector_part q)) (s * angle) u)).

(** Of a waypoint where lengths are straight, these come behind its pose, and then how wide the tube is that begins
    there, around poses whose positions and quaternions are straight: by how much each coordinate of the position may be
    off, and each of the vector part of a quaternion with the scalar part 1. In the tube, the platform is at the pose at
    which the cables of the machine itself have these lengths. *)
Definition on_chord (v w : waypoint) (s : R) : pose :=
  let x := on_line v w s in
  Pose (Vec (x 0) (x 1) (x 2))%nat (turn_by (Quaternion (Vec (x 3) (x 4) (x 5)) (x 6)))%nat.

Definition in_unit_box (v : vec R) : Prop := Rabs (vx v) <= 1 /\ Rabs (vy v) <= 1 /\ Rabs (vz v) <= 1.
Definition in_tube (v : waypoint) (P P' : pose) : Prop :=
  exists y z : vec R, in_unit_box y /\ in_unit_box z /\
    P' = Pose (plus (position P) (times (coordinate v 13) y))
              (fun u => turn_by (Quaternion (times (coordinate v 14) z) 1) (turn P u)).

Definition has_lengths (m : machine) (l : six R) (P : pose) : Prop :=
  all6 (zip6 (fun a x => cable_length P a = x) (anchors (itself m)) l).
Definition held (m : machine) (v w : waypoint) (s : R) (P : pose) : Prop :=
  in_tube v (on_chord v w s) P /\ has_lengths m (map6 (on_line v w s) (Six 7 8 9 10 11 12)%nat) P.

(** Its segments: for each s from 0 to 1, where the platform is meant to be. *)
Fixpoint segments (m : machine) (l : law) (path : list waypoint) : list (R -> pose -> Prop) :=
  match path with
  | nil => nil
  | v :: rest =>
      match l, rest with
      | Straight, w :: _ => (fun s => eq (pose_at m (on_line v w s))) :: segments m l rest
      | Spline, b :: c :: d :: _ => (fun s => eq (pose_at m (on_spline v b c d s))) :: segments m l rest
      | Geodesic, w :: _ => (fun s => eq (on_geodesic v w s)) :: segments m l rest
      | Lengths, w :: _ => held m v w :: segments m l rest
      | _, _ => nil
      end
  end.

(** Each ends where the next begins. *)
Fixpoint joined (l : list (R -> pose -> Prop)) : Prop :=
  match l with
  | motion :: (next :: _) as rest => (forall P, motion 1 P -> next 0 P) /\ joined rest
  | _ => True
  end.

(** There is a segment; everywhere on each, there is exactly one pose at which the platform is meant to be; and it is
    feasible for every machine, and at every pose, within the tolerances. *)
Definition wrench_feasible (m : machine) (l : law) (path : list waypoint) (tension_margin length_margin : Q) : Prop :=
  segments m l path <> nil /\ joined (segments m l path) /\
  Forall (fun motion : R -> pose -> Prop => forall s, 0 <= s <= 1 ->
    exists P, motion s P /\ (forall P', motion s P' -> P' = P) /\
    forall b P', is_built m b -> is_tracked m P P' -> feasible_at m b tension_margin length_margin P')
    (segments m l path).
