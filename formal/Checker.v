(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * What is computed of a certificate, by the Interval library's operations

    [Soundness.v] proves that what is accepted here is true. *)

From Coq Require Import QArith ZArith List Bool.
From Flocq Require Import Zaux.
From Interval Require Import Float.Specific_sig Interval.Interval Interval.Float_full Real.Xreal.
From Interval Require Import Float.Basic Float.Sig.
From Taut Require Import Statement Certificate.
Import ListNotations.

Module Checker (F : FloatOps with Definition radix := radix2 with Definition sensible_format := true).

Module I := FloatIntervalFull F.
Notation interval := I.type.

Section Precision.

Variable prec : F.precision.
Definition add := I.add prec.
Definition sub := I.sub prec.
Definition mul := I.mul prec.
Definition div := I.div prec.
Definition integer := I.fromZ prec.
Definition zero := integer 0.
Definition one := integer 1.
Definition fraction (q : Q) : interval := div (integer (Qnum q)) (integer (Zpos (Qden q))).

(** Strict tests; an empty interval or one that is not a number fails both. *)
Definition above0 (x : interval) : bool := match I.sign_strict x with Xgt => true | _ => false end.
Definition apart0 (x : interval) : bool := match I.sign_strict x with Xgt | Xlt => true | _ => false end.
Definition below (x y : interval) : bool := above0 (sub y x).

Definition symmetric (x : interval) : interval := I.join (I.neg x) x.
Definition norm_of (v : vec interval) : interval :=
  I.sqrt prec (add (add (I.sqr prec (vx v)) (I.sqr prec (vy v))) (I.sqr prec (vz v))).

(** ** Forms: q(m), then both that and q'(s) of a machine that deviates, then the slopes from one to the other: along s,
    and along how far the machine deviates in each ball; none where it is 0 *)

Definition block : Type := option (vec interval).
Record form := Form { mid : interval; over : interval; slope : interval; slopes : list block }.

Definition v_map (f : interval -> interval) (v : vec interval) := Vec (f (vx v)) (f (vy v)) (f (vz v)).
Definition b_map (f : interval -> interval) : list block -> list block := map (option_map (v_map f)).
Definition b_plus (u v : block) : block :=
  match u, v with
  | None, v => v
  | u, None => u
  | Some u, Some v => Some (Vec (add (vx u) (vx v)) (add (vy u) (vy v)) (add (vz u) (vz v)))
  end.
Fixpoint b_add (k l : list block) : list block :=
  match k, l with [], l => l | k, [] => k | u :: k, v :: l => b_plus u v :: b_add k l end.
Definition b_scale (c : interval) : list block -> list block := b_map (fun x => mul x c).
(** The slopes v in one ball. *)
Definition b_only (ball : nat) (v : vec interval) : list block := repeat None ball ++ [Some v].

Definition nothing : form := Form I.nai I.nai I.nai (repeat (Some (Vec I.nai I.nai I.nai)) balls).
Definition constant (x : interval) : form := Form x x zero [].
Definition f_neg f := Form (I.neg (mid f)) (I.neg (over f)) (I.neg (slope f)) (b_map I.neg (slopes f)).
Definition f_add f g :=
  Form (add (mid f) (mid g)) (add (over f) (over g)) (add (slope f) (slope g)) (b_add (slopes f) (slopes g)).
Definition f_sub f g :=
  Form (sub (mid f) (mid g)) (sub (over f) (over g)) (sub (slope f) (slope g))
    (b_add (slopes f) (b_map I.neg (slopes g))).
Definition f_mul f g := Form (mul (mid f) (mid g)) (mul (over f) (over g))
  (add (mul (slope f) (over g)) (mul (mid f) (slope g)))
  (b_add (b_scale (over g) (slopes f)) (b_scale (mid f) (slopes g))).
(** Division by zero and roots of negative numbers have values in Coq, and no slopes: nothing is known where they might
    be. *)
Definition f_div f g :=
  if apart0 (mid g) && apart0 (over g) then
    let q := div (mid f) (mid g) in
    Form q (div (over f) (over g)) (div (sub (slope f) (mul q (slope g))) (over g))
      (b_map (fun x => div x (over g)) (b_add (slopes f) (b_map I.neg (b_scale q (slopes g)))))
  else nothing.
Definition f_sqrt f :=
  if above0 (mid f) && above0 (over f) then
    let a := I.sqrt prec (mid f) in
    let b := I.sqrt prec (over f) in
    Form a b (div (slope f) (add a b)) (b_map (fun x => div x (add a b)) (slopes f))
  else nothing.
Definition f_sin f :=
  let c := I.cos prec (over f) in
  Form (I.sin prec (mid f)) (I.sin prec (over f)) (mul c (slope f)) (b_scale c (slopes f)).
Definition f_cos f :=
  let s := I.neg (I.sin prec (over f)) in
  Form (I.cos prec (mid f)) (I.cos prec (over f)) (mul s (slope f)) (b_scale s (slopes f)).

Variable reach : interval * list interval.       (* s - m, and the balls' radii *)

(** By how much deviations within these radii change what has these slopes. *)
Fixpoint b_change (radii : list interval) (l : list block) : interval :=
  match l, radii with
  | [], _ => zero
  | _, [] => I.nai
  | None :: l, _ :: radii => b_change radii l
  | Some v :: l, r :: radii => add (symmetric (mul r (norm_of v))) (b_change radii l)
  end.
Definition tight f :=
  Form (mid f) (I.meet (over f) (add (mid f) (add (mul (slope f) (fst reach)) (b_change (snd reach) (slopes f)))))
    (slope f) (slopes f).

(** ** Poses *)

Fixpoint eval (p : nat -> form) (e : expr) : form :=
  match e with
  | Number q => constant (fraction q)
  | Pi => constant (I.pi prec)
  | Param i => p i
  | Minus e => f_neg (eval p e)
  | Plus d e => f_add (eval p d) (eval p e)
  | Sub d e => f_sub (eval p d) (eval p e)
  | Times d e => f_mul (eval p d) (eval p e)
  | Over d e => f_div (eval p d) (eval p e)
  | Sqrt e => f_sqrt (eval p e)
  | Sin e => f_sin (eval p e)
  | Cos e => f_cos (eval p e)
  end.

(** By how much a platform may be turned. *)
Definition angle_of (m : machine) : interval :=
  I.abs (mid (eval (fun _ => constant zero) (of_orientation (tolerance m)))).

Definition f_rot_x c s v :=
  Vec (vx v) (f_sub (f_mul c (vy v)) (f_mul s (vz v))) (f_add (f_mul s (vy v)) (f_mul c (vz v))).
Definition f_rot_y c s v :=
  Vec (f_add (f_mul c (vx v)) (f_mul s (vz v))) (vy v) (f_sub (f_mul c (vz v)) (f_mul s (vx v))).
Definition f_rot_z c s v :=
  Vec (f_sub (f_mul c (vx v)) (f_mul s (vy v))) (f_add (f_mul s (vx v)) (f_mul c (vy v))) (vz v).
Definition v_add u v := Vec (f_add (vx u) (vx v)) (f_add (vy u) (vy v)) (f_add (vz u) (vz v)).
Definition v_sub u v := Vec (f_sub (vx u) (vx v)) (f_sub (vy u) (vy v)) (f_sub (vz u) (vz v)).
Definition v_scale k v := Vec (f_mul k (vx v)) (f_mul k (vy v)) (f_mul k (vz v)).
Definition v_tight v := Vec (tight (vx v)) (tight (vy v)) (tight (vz v)).
Definition v_cross u v := Vec
  (f_sub (f_mul (vy u) (vz v)) (f_mul (vz u) (vy v)))
  (f_sub (f_mul (vz u) (vx v)) (f_mul (vx u) (vz v)))
  (f_sub (f_mul (vx u) (vy v)) (f_mul (vy u) (vx v))).
Definition v_dot u v := f_add (f_add (f_mul (vx u) (vx v)) (f_mul (vy u) (vy v))) (f_mul (vz u) (vz v)).
Definition v_rational (v : vec Q) := let k q := constant (fraction q) in Vec (k (vx v)) (k (vy v)) (k (vz v)).

(** A point somewhere in a ball of this radius around V. *)
Definition off_by (ball : nat) (r : interval) (unit : vec interval) : form :=
  Form zero (symmetric r) zero (b_only ball unit).
Definition v_within (ball : nat) (q : Q) (v : vec form) : vec form :=
  if Qeq_bool q 0 then v
  else
    let by_unit := off_by ball (fraction q) in
    Vec (f_add (vx v) (by_unit (Vec one zero zero))) (f_add (vy v) (by_unit (Vec zero one zero)))
        (f_add (vz v) (by_unit (Vec zero zero one))).

(** The image of V under a turn by no more than e, about any axis: v + w × (v + d), with w in the ball of turns. *)
Definition v_turned (e : interval) (v : vec form) : vec form :=
  let change := symmetric (mul e (norm_of (Vec (over (vx v)) (over (vy v)) (over (vz v))))) in
  let near f := add (over f) change in
  let moved f unit := Form (mid f) (near f) (slope f) (b_add (slopes f) (b_only 1 unit)) in
  let x := near (vx v) in let y := near (vy v) in let z := near (vz v) in
  Vec (moved (vx v) (Vec zero z (I.neg y))) (moved (vy v) (Vec (I.neg z) zero x))
      (moved (vz v) (Vec y (I.neg x) zero)).
Definition is_zero_number (e : expr) : bool := match e with Number q => Qeq_bool q 0 | _ => false end.

(** Turned about the axis N by F. *)
Definition f_turn_about (N : vec form) (F : form) (v : vec form) : vec form :=
  let c := f_cos F in
  v_add (v_add (v_scale c v) (v_scale (f_sin F) (v_cross N v)))
    (v_scale (f_mul (f_sub (constant one) c) (v_dot N v)) N).
(** Turned by the quaternion of vector part U and scalar part W. *)
Definition f_turn_by (U : vec form) (W : form) (v : vec form) : vec form :=
  let square := v_dot U U in
  let two := constant (integer 2) in
  v_scale (f_div (constant one) (f_add square (f_mul W W)))
    (v_add (v_add (v_scale (f_sub (f_mul W W) square) v) (v_scale (f_mul two (v_dot U v)) U))
           (v_scale (f_mul two W) (v_cross U v))).
Definition fractions (v : vec Q) : vec interval := Vec (fraction (vx v)) (fraction (vy v)) (fraction (vz v)).
Definition unit_form (axis : vec Q) : vec form :=
  let v := fractions axis in
  let k x := constant (mul (div one (norm_of v)) x) in
  Vec (k (vx v)) (k (vy v)) (k (vz v)).

(** The images of the unit vectors. *)
Definition columns_of (turn : vec form -> vec form) : vec (vec form) :=
  let i := constant one in
  let o := constant zero in
  Vec (turn (Vec i o o)) (turn (Vec o i o)) (turn (Vec o o i)).
Definition rotation (a : angles) (p : nat -> form) : vec (vec form) :=
  let v := eval p in
  match a with
  | TiltTorsion phi theta sigma =>
      let f := v phi in let t := v theta in let g := f_sub (v sigma) f in
      let cf := f_cos f in let sf := f_sin f in let ct := f_cos t in let st := f_sin t in
      let cg := f_cos g in let sg := f_sin g in
      columns_of (fun u => f_rot_z cf sf (f_rot_y ct st (f_rot_z cg sg u)))
  | RollPitchYaw roll pitch yaw =>
      let f := v yaw in let t := v pitch in let g := v roll in
      let cf := f_cos f in let sf := f_sin f in let ct := f_cos t in let st := f_sin t in
      let cg := f_cos g in let sg := f_sin g in
      columns_of (fun u => f_rot_z cf sf (f_rot_y ct st (f_rot_x cg sg u)))
  | Zyz alpha beta gamma =>
      let f := v alpha in let t := v beta in let g := v gamma in
      let cf := f_cos f in let sf := f_sin f in let ct := f_cos t in let st := f_sin t in
      let cg := f_cos g in let sg := f_sin g in
      columns_of (fun u => f_rot_z cf sf (f_rot_y ct st (f_rot_z cg sg u)))
  | About axis angle => columns_of (f_turn_about (unit_form axis) (v angle))
  end.
Definition is_vector (v : vec Q) : bool := negb (Qeq_bool (vx v) 0 && Qeq_bool (vy v) 0 && Qeq_bool (vz v) 0).
Definition has_axis (a : angles) : bool := match a with About axis _ => is_vector axis | _ => true end.

Definition turned (R : vec (vec form)) (u : vec form) : vec form :=
  v_add (v_add (v_scale (vx u) (vx R)) (v_scale (vy u) (vy R))) (v_scale (vz u) (vz R)).

(** ** Six of something *)

Definition sum (l : six interval) : interval := fold6 add l.
Definition f_sum (l : six form) : form := fold6 f_add l.
Definition every (l : six bool) : bool := fold6 andb l.
Definition units : six (six Z) :=
  (Six (Six 1 0 0 0 0 0) (Six 0 1 0 0 0 0) (Six 0 0 1 0 0 0)
       (Six 0 0 0 1 0 0) (Six 0 0 0 0 1 0) (Six 0 0 0 0 0 1))%Z.

(** ** Ellipsoids

    The form of a matrix, given by rows, as a sum of positive squares (Lemmas.v): if it is one, and the matrix is
    symmetric. *)

Fixpoint agree (k l : list Q) : bool :=
  match k, l with [], [] => true | x :: k, y :: l => Qeq_bool x y && agree k l | _, _ => false end.
Fixpoint less_times (k : Q) (s r : list Q) : list Q :=
  match s, r with
  | s, [] => s
  | [], x :: r => Qred (- (k * x)) :: less_times k [] r
  | y :: s, x :: r => Qred (y - k * x) :: less_times k s r
  end.
Fixpoint reduced (r : list Q) (k : list Q) (rows : list (list Q)) : list (list Q) :=
  match k, rows with
  | x :: k, s :: rows => (if Qeq_bool x 0 then s else less_times x s r) :: reduced r k rows
  | _, _ => []
  end.
Fixpoint squares (n : nat) (rows : list (list Q)) : option (list (Q * list Q)) :=
  match n, rows with
  | O, [] => Some []
  | S n, (a :: r) :: rows =>
      if Z.ltb 0 (Qnum a) && agree (map (hd 0%Q) rows) r then
        let k := map (fun x => Qred (x / a)) r in
        option_map (cons (a, k)) (squares n (reduced r k (map (@tl Q) rows)))
      else None
  | _, _ => None
  end.

Fixpoint less_range (c : interval) (y : list interval) (k : list Q) : list interval :=
  match y, k with
  | y, [] => y
  | [], x :: k => I.neg (mul c (fraction x)) :: less_range c [] k
  | y1 :: y, x :: k => (if Qeq_bool x 0 then y1 else sub y1 (mul c (fraction x))) :: less_range c y k
  end.
Fixpoint spread_range (l : list (Q * list Q)) (y : list interval) : interval :=
  match l, y with
  | (a, k) :: l, c :: y => add (div (I.sqr prec c) (fraction a)) (spread_range l (less_range c y k))
  | _, _ => zero
  end.

(** ** The load

    What an item makes of a row y is a form, of one of its wrenches, and a range of what others add to that. *)

Definition range (f : form) : interval := over (tight f).
Definition size (v : vec form) : interval := norm_of (Vec (range (vx v)) (range (vy v)) (range (vz v))).

Definition part : Type := form * interval.
Definition only (x : interval) : part := (constant zero, x).

Definition along (c : six interval) (w : six Q) : interval := sum (zip6 (fun c q => mul c (fraction q)) c w).
Definition list_of {A : Type} (l : six A) : list A := [at1 l; at2 l; at3 l; at4 l; at5 l; at6 l].
Definition ellipsoid_part (c : six interval) (center shift : six Q) (shape : six (six Q)) : part :=
  match squares 6 (list_of (map6 list_of shape)) with
  | Some l => (constant (along c center),
               symmetric (add (I.abs (along c shift)) (I.sqrt prec (spread_range l (list_of c)))))
  | None => only I.nai
  end.

(** Of numbers from [lower] to [upper] times what f encloses. *)
Definition middle (lower upper : Q) : interval := fraction ((lower + upper) * (1 # 2)).
Definition half_range (lower upper : Q) : interval := fraction ((upper - lower) * (1 # 2)).
Definition multiples (lower upper : Q) (f : form) : part :=
  (f_mul (constant (middle lower upper)) f, mul (half_range lower upper) (I.abs (range f))).

(** h.v for all v of a set. *)
Definition vectors_part (set : vectors) (h : vec form) : part :=
  match set with
  | Ball radius => only (symmetric (mul (fraction radius) (size h)))
  | Disc radius normal =>
      let n := v_rational normal in only (symmetric (div (mul (fraction radius) (size (v_cross n h))) (size n)))
  | Along direction lower upper =>
      let e := v_rational direction in
      let p := multiples lower upper (f_div (v_dot h e) (constant (size e))) in
      (fst p, symmetric (snd p))
  end.

Section Load.

Variables (R : vec (vec form)) (m : machine).

Definition load_point_form : vec form := v_within 2 (of_load_point (tolerance m)) (v_rational (load_point m)).
Definition arm_form (point : vec form) : vec form := v_tight (turned R (v_sub point load_point_form)).
Definition row_form (c : six interval) : vec form * vec form :=
  (Vec (constant (at1 c)) (constant (at2 c)) (constant (at3 c)),
   Vec (constant (at4 c)) (constant (at5 c)) (constant (at6 c))).
Definition covector_form (y : vec form * vec form) (r : vec form) : vec form := v_add (fst y) (v_cross (snd y) r).
Definition seen_form (a : axes) (h : vec form) : vec form :=
  match a with OfWorld => h | OfPlatform => Vec (v_dot (vx R) h) (v_dot (vy R) h) (v_dot (vz R) h) end.

Definition weight_part (y : vec form * vec form) (lower upper : Q) (gravity point : vec Q) (tolerance : Q) : part :=
  let g := v_rational gravity in
  let p := multiples lower upper (v_dot (covector_form y (arm_form (v_rational point))) g) in
  let most := add (I.abs (middle lower upper)) (half_range lower upper) in
  (fst p, symmetric (add (snd p) (mul most (mul (fraction tolerance) (size (v_cross g (snd y))))))).

Definition q_minus (u v : vec Q) : vec Q := (Vec (vx u - vx v) (vy u - vy v) (vz u - vz v))%Q.
Definition case_form (h k : vec form) (w : vec Q * vec Q) : form :=
  f_add (v_dot h (v_rational (fst w))) (v_dot k (v_rational (snd w))).
Fixpoint hull (f : vec Q * vec Q -> interval) (l : list (vec Q * vec Q)) : interval :=
  match l with [] => I.nai | [w] => f w | w :: l => I.join (f w) (hull f l) end.
Definition cases_part (h k : vec form) (l : list (vec Q * vec Q)) : part :=
  match l with
  | [] => only I.nai
  | u :: _ => (case_form h k u,
               hull (fun w => range (case_form h k (q_minus (fst w) (fst u), q_minus (snd w) (snd u)))) l)
  end.

Definition item_part (c : six interval) (i : item) : part :=
  let y := row_form c in
  match i with
  | Ellipsoid center shift shape => ellipsoid_part c center shift shape
  | Weight lower upper gravity point tolerance => weight_part y lower upper gravity point tolerance
  | Force set a point => vectors_part set (seen_form a (covector_form y (arm_form (v_rational point))))
  | Moment set a => vectors_part set (seen_form a (snd y))
  | LoadCases cases a point =>
      cases_part (seen_form a (covector_form y (arm_form (v_rational point)))) (seen_form a (snd y)) cases
  end.
Definition load_part (c : six interval) (l : list item) : part :=
  fold_right (fun i t => let p := item_part c i in (f_add (fst p) (fst t), add (snd p) (snd t))) (only zero) l.

End Load.

(** ** A box *)

Definition strictly (limits : Q * Q) (margin : Q) (x : interval) : bool :=
  below (fraction (fst limits + margin)) x && below x (fraction (snd limits - margin)).

(** The columns of D: a vector of force, and of moment about the load point. *)
Definition column_form (R : vec (vec form)) (P : vec form) (m : machine) (i : nat) (c : cable) (t : Q * Q) : six form :=
  let u := v_within (4 + 2 * i) (snd t) (v_rational (platform c)) in
  let d := v_tight (v_sub (v_add P (turned R u)) (v_within (3 + 2 * i) (fst t) (v_rational (base c)))) in
  let k := v_cross (arm_form R m u) d in
  Six (vx d) (vy d) (vz d) (vx k) (vy k) (vz k).
Definition column_forms (R : vec (vec form)) (P : vec form) (m : machine) : six (six form) :=
  zip6 (fun f t => f t) (zip6 (column_form R P m) (Six 0 1 2 3 4 5)%nat (cables m)) (of_anchors (tolerance m)).
Definition length_range (d : six form) : interval :=
  let v := Vec (at1 d) (at2 d) (at3 d) in range (f_sqrt (v_dot v v)).

(** C D, its difference from the unit matrix, and what C makes of what is left of the load. *)
Definition product (C : six (six interval)) (columns : six (six form)) : six (six form) :=
  map6 (fun c => map6 (fun d => f_sum (zip6 (fun a e => f_mul (constant a) e) c d)) columns) C.
Definition error_ranges (CD : six (six form)) : six (six interval) :=
  zip6 (fun row unit => zip6 (fun e z => over (tight (f_sub (constant (integer z)) e))) row unit) CD units.
Definition rest_ranges (R : vec (vec form)) (m : machine) (C : six (six interval)) (CD : six (six form))
    (x0 : six interval) : six interval :=
  zip6 (fun c row =>
    let p := load_part R m c (load m) in
    add (range (f_sub (fst p) (f_sum (zip6 (fun e x => f_mul e (constant x)) row x0)))) (snd p)) C CD.

Definition refine (W : six interval) (E : six (six interval)) (Y : six interval) : six interval :=
  zip6 (fun w row => add w (sum (zip6 mul row Y))) W E.

(** From ranges of I - C D, of W and of the lengths: whether all limits hold. *)
Definition decide (m : machine) (tension_margin length_margin : Q) (lengths x0 : six interval)
    (E : six (six interval)) (W : six interval) : bool :=
  let rho := fold6 I.join (map6 (fun row => sum (map6 I.abs row)) E) in
  let y0 := symmetric (div (fold6 I.join (map6 I.abs W)) (sub one rho)) in
  let Y := refine W E (refine W E (Six y0 y0 y0 y0 y0 y0)) in
  let tensions := zip6 mul lengths (zip6 add x0 Y) in
  below rho one &&
  every (zip6 (fun c t => strictly (tension c) tension_margin t) (cables m) tensions) &&
  every (zip6 (fun c l => strictly (length c) length_margin l && above0 l) (cables m) lengths).

Definition number (scale : positive) (z : Z) : interval := fraction (z # Pos.pow 2 scale).

(** Where the platform is meant to be, and whether [turn] is known to be one. *)
Record pose_form := PoseForm { is_turn : bool; place : vec form; images : vec (vec form) }.

Definition posed (m : machine) (p : nat -> form) : pose_form :=
  PoseForm (has_axis (pose_angles m))
    (Vec (eval p (vx (pose_position m))) (eval p (vy (pose_position m))) (eval p (vz (pose_position m))))
    (rotation (pose_angles m) p).

(** Where it may be. *)
Definition orientation_form (m : machine) (R : vec (vec form)) : vec (vec form) :=
  let by_angle := v_turned (angle_of m) in
  if is_zero_number (of_orientation (tolerance m)) then R
  else Vec (by_angle (vx R)) (by_angle (vy R)) (by_angle (vz R)).
Definition position_form (m : machine) (P : vec form) : vec form := v_within 0 (of_position (tolerance m)) P.

Definition check_pose (m : machine) (tension_margin length_margin : Q) (b : box) (p : pose_form) : bool :=
  let R := orientation_form m (images p) in
  let P := position_form m (place p) in
  let columns := column_forms R P m in
  let C := map6 (map6 (number (scale b))) (inverse b) in
  let x0 := map6 (number (scale b)) (densities b) in
  let CD := product C columns in
  is_turn p &&
  decide m tension_margin length_margin (map6 length_range columns) x0 (error_ranges CD)
    (rest_ranges R m C CD x0).

End Precision.

(** The balls in which a machine deviates. *)
Definition radii (prec : F.precision) (m : machine) : list interval :=
  let t := tolerance m in
  let r := fraction prec in
  let anchors_of q l := r (fst q) :: r (snd q) :: l in
  let a := of_anchors t in
  r (of_position t) :: angle_of prec m :: r (of_load_point t) ::
    anchors_of (at1 a) (anchors_of (at2 a) (anchors_of (at3 a) (anchors_of (at4 a) (anchors_of (at5 a)
      (anchors_of (at6 a) []))))).

Definition from_to (prec : F.precision) (l r : Q) : interval := I.join (fraction prec l) (fraction prec r).

(** ** Motions: from enclosures of m and of all s *)

Definition parameters_form : Type := interval -> interval -> nat -> form.
Definition poses_form : Type := interval -> interval -> pose_form.

Definition point (prec : F.precision) (u : waypoint) (i : nat) : interval :=
  let (q, h) := nth i u (0%Q, 0%Z) in add prec (fraction prec q) (mul prec (integer prec h) (I.pi prec)).

Definition line_form (prec : F.precision) (v w : waypoint) : parameters_form := fun m S i =>
  let a := point prec v i in
  let k := sub prec (point prec w i) a in
  Form (add prec a (mul prec m k)) (add prec a (mul prec S k)) k [].

(** By the differences of control points, in powers of s. *)
Definition spline_form (prec : F.precision) (a b c d : waypoint) : parameters_form := fun m S i =>
  let at_b := point prec b i in
  let e := sub prec at_b (point prec a i) in
  let f := sub prec (point prec c i) at_b in
  let g := sub prec (point prec d i) (point prec c i) in
  let part x n := constant prec (div prec x (integer prec n)) in
  let s := Form m S (one prec) [] in
  let times_s := f_mul prec s in
  f_add prec (constant prec (add prec at_b (div prec (sub prec f e) (integer prec 6%Z))))
    (times_s (f_add prec (part (add prec e f) 2%Z) (times_s (f_add prec (part (sub prec f e) 2%Z)
      (times_s (part (add prec (sub prec g (mul prec (integer prec 2%Z) f)) e) 6%Z)))))).

(** Quaternions of rational numbers. *)
Definition coordinate_q (w : waypoint) (i : nat) : Q := fst (nth i w (0%Q, 0%Z)).
Definition vector_q (w : waypoint) : vec Q := Vec (coordinate_q w 3) (coordinate_q w 4) (coordinate_q w 5).
Definition dot_q (u v : vec Q) : Q := (vx u * vx v + vy u * vy v + vz u * vz v)%Q.
Definition between_q (v w : waypoint) : vec Q * Q :=
  let p := vector_q v in let q := vector_q w in
  let a := coordinate_q v 6 in let b := coordinate_q w 6 in
  ((Vec (a * vx q - b * vx p - (vy p * vz q - vz p * vy q)) (a * vy q - b * vy p - (vz p * vx q - vx p * vz q))
        (a * vz q - b * vz p - (vx p * vy q - vy p * vx q)), a * b + dot_q p q)%Q).
Definition no_half_turns (w : waypoint) : bool := forallb (fun c => Z.eqb (snd c) 0) w.

(** Whether one geodesic leads from pose to pose. *)
Definition turns_meet (v w : waypoint) : bool :=
  no_half_turns v && no_half_turns w && negb (Qeq_bool (snd (between_q v w)) 0).

Definition geodesic_form (prec : F.precision) (v w : waypoint) : poses_form := fun m S =>
  let (u, c) := between_q v w in
  let angle := mul prec (integer prec 2) (I.atan prec (div prec (norm_of prec (fractions prec u)) (fraction prec c))) in
  let turn x := if is_vector u
    then f_turn_about prec (unit_form prec u) (f_mul prec (Form m S (one prec) []) (constant prec angle)) x else x in
  let x := line_form prec v w m S in
  PoseForm (turns_meet v w) (Vec (x 0%nat) (x 1%nat) (x 2%nat))
    (columns_of prec (fun x =>
      f_turn_by prec (v_rational prec (vector_q v)) (constant prec (fraction prec (coordinate_q v 6))) (turn x))).

(** ** Lengths that are held: the platform is near the chord from pose to pose *)

Definition chord_form (prec : F.precision) (v w : waypoint) : poses_form := fun m S =>
  let x := line_form prec v w m S in
  let u := Vec (x 3%nat) (x 4%nat) (x 5%nat) in
  let w := x 6%nat in
  PoseForm (apart0 (over (f_add prec (v_dot prec u u) (f_mul prec w w)))) (Vec (x 0%nat) (x 1%nat) (x 2%nat))
    (columns_of prec (f_turn_by prec u w)).

(** Coordinates in a tube: of the position, and of the quaternion's vector part. *)
Definition scaled (prec : F.precision) (q : Q) (V : vec form) : vec form :=
  v_scale prec (constant prec (fraction prec q)) V.
Definition shift_form (prec : F.precision) (v : waypoint) : vec form -> vec form := scaled prec (coordinate_q v 13).
Definition tube_turn (prec : F.precision) (v : waypoint) (y V : vec form) : vec form :=
  f_turn_by prec (scaled prec (coordinate_q v 14) y) (constant prec (one prec)) V.
Definition first_form (prec : F.precision) (z : six Q) : vec form := v_rational prec (Vec (at1 z) (at2 z) (at3 z)).
Definition last_form (prec : F.precision) (z : six Q) : vec form := v_rational prec (Vec (at4 z) (at5 z) (at6 z)).

Section Tube.

Variables (prec : F.precision) (m : machine) (v w : waypoint) (x S : interval).

Definition tube_reach : interval * list interval := (sub prec S x, repeat (zero prec) balls).
Definition length_form (i : nat) : form := line_form prec v w x S (7 + i)%nat.

(** From the chord's pose over a box: where a cable's anchor is from the platform's origin. *)
Definition arm_range (chord : pose_form) (c : cable) : vec form :=
  v_tight prec tube_reach (turned prec (images chord) (v_rational prec (platform c))).

(** Half of |d|^2 - L^2, at some coordinates in the tube. *)
Definition half_form (d : vec form) (L : form) : form :=
  f_mul prec (constant prec (fraction prec (1 # 2))) (f_sub prec (v_dot prec d d) (f_mul prec L L)).
Definition vector_form (position y z : vec form) (c : cable) (arm : vec form) : vec form :=
  v_sub prec (v_add prec (v_add prec position (shift_form prec v y)) (tube_turn prec v z arm))
    (v_rational prec (base c)).
Definition start_form (chord : pose_form) (z : six Q) (c : cable) (arm : vec form) (L : form) : form :=
  half_form (v_tight prec tube_reach (vector_form (place chord) (first_form prec z) (last_form prec z) c arm)) L.

(** The same anywhere in the tube, for all s: its slopes are those along the tube's coordinates. *)
Definition whole (f : form) : form := constant prec (over f).
Definition v_whole (V : vec form) : vec form := Vec (whole (vx V)) (whole (vy V)) (whole (vz V)).
Definition any_form (ball : nat) (unit : vec interval) : form :=
  Form (symmetric (one prec)) (symmetric (one prec)) (zero prec) (b_only ball unit).
Definition any_vector (ball : nat) : vec form :=
  let i := one prec in
  let o := zero prec in
  Vec (any_form ball (Vec i o o)) (any_form ball (Vec o i o)) (any_form ball (Vec o o i)).
Definition tube_form (chord : pose_form) (c : cable) (arm : vec form) (L : form) : form :=
  half_form (vector_form (v_whole (place chord)) (any_vector 0) (any_vector 1) c (v_whole arm)) (whole L).
Definition row_of_slopes (f : form) : six interval :=
  let o := zero prec in
  let in_ball b := match nth b (slopes f) None with Some u => u | None => Vec o o o end in
  let y := in_ball 0%nat in
  let z := in_ball 1%nat in
  Six (vx y) (vy y) (vz y) (vx z) (vy z) (vz z).

Definition transposed {A : Type} (M : six (six A)) : six (six A) :=
  Six (map6 at1 M) (map6 at2 M) (map6 at3 M) (map6 at4 M) (map6 at5 M) (map6 at6 M).
Definition indices : six nat := (Six 0 1 2 3 4 5)%nat.

(** There is one pose with these lengths, and it is near the guess. *)
Definition check_tube (b : tube_box) : bool :=
  let chord := chord_form prec v w x S in
  let arms := map6 (arm_range chord) (cables m) in
  let lengths := map6 length_form indices in
  let C := map6 (map6 (number prec (tube_scale b))) (tube_inverse b) in
  let starts := zip6 (fun f L => f L) (zip6 (start_form chord (guess b)) (cables m) arms) lengths in
  let changes := zip6 (fun f L => f L) (zip6 (tube_form chord) (cables m) arms) lengths in
  let A := transposed (map6 row_of_slopes changes) in
  let left_of c a z := sub prec (integer prec z) (sum prec (zip6 (mul prec) c a)) in
  let E := zip6 (fun c unit => zip6 (left_of c) A unit) C units in
  let rho := fold6 I.join (map6 (fun row => sum prec (map6 I.abs row)) E) in
  let step c := f_sum prec (zip6 (fun a f => f_mul prec (constant prec a) f) c starts) in
  let eta := fold6 I.join (map6 (fun c => I.abs (range prec tube_reach (step c))) C) in
  every (map6 (fun L => above0 (over L)) lengths) &&
  every (map6 (fun z => Qle_bool (z + within b) 1 && Qle_bool (within b - z) 1) (guess b)) &&
  Z.ltb 0 (Qnum (1 - left b)) && below prec rho (fraction prec (left b)) &&
  below prec eta (fraction prec (within b * (1 - left b))).

End Tube.

(** The poses at some coordinates in the tube, and a machine whose platform may be as far from them as another in the
    tube is whose coordinates are within q of these. *)
Definition guess_form (prec : F.precision) (v w : waypoint) (z : six Q) : poses_form := fun x S =>
  let p := chord_form prec v w x S in
  let turn := tube_turn prec v (last_form prec z) in
  PoseForm (is_turn p) (v_add prec (place p) (shift_form prec v (first_form prec z)))
    (Vec (turn (vx (images p))) (turn (vy (images p))) (turn (vz (images p)))).
Definition near_guess (m : machine) (v : waypoint) (q : Q) : machine :=
  Machine (cables m) (load_point m) (load m) (pose_position m) (pose_angles m)
    (Tolerances (of_anchors (tolerance m)) (of_load_point (tolerance m)) (q * coordinate_q v 13 * (7 # 4))
      (Number (q * coordinate_q v 14 * (21 # 4)))).
Definition is_exact (m : machine) : bool :=
  let t := tolerance m in
  every (map6 (fun a => Qeq_bool (fst a) 0 && Qeq_bool (snd a) 0) (of_anchors t)) &&
  Qeq_bool (of_load_point t) 0 && Qeq_bool (of_position t) 0 && is_zero_number (of_orientation t).
Definition has_tube (v : waypoint) : bool :=
  no_half_turns v && Z.ltb 0 (Qnum (coordinate_q v 13)) && Z.ltb 0 (Qnum (coordinate_q v 14)) &&
  Qle_bool (coordinate_q v 14) (1 # 8).

(** Of two tubes in a row, one has to contain the other. *)
Definition contains_tube (v w : waypoint) : bool :=
  Qle_bool (coordinate_q w 13) (coordinate_q v 13) && Qle_bool (coordinate_q w 14) (coordinate_q v 14).
Definition tubes_nest (v w : waypoint) : bool := contains_tube v w || contains_tube w v.

(** ** A path *)

Inductive motion_form := Explicit (poses : poses_form) | Held (v w : waypoint).

Fixpoint motions (prec : F.precision) (m : machine) (l : law) (path : list waypoint) : list motion_form :=
  match path with
  | [] => []
  | v :: rest =>
      match l, rest with
      | Straight, w :: _ => Explicit (fun x S => posed prec m (line_form prec v w x S)) :: motions prec m l rest
      | Spline, b :: c :: d :: _ =>
          Explicit (fun x S => posed prec m (spline_form prec v b c d x S)) :: motions prec m l rest
      | Geodesic, w :: _ => Explicit (geodesic_form prec v w) :: motions prec m l rest
      | Lengths, w :: _ => Held v w :: motions prec m l rest
      | _, _ => []
      end
  end.

(** What has to hold of waypoints that follow one another, for their segments to be joined. *)
Fixpoint pairs (f : waypoint -> waypoint -> bool) (path : list waypoint) : bool :=
  match path with v :: (w :: _) as rest => f v w && pairs f rest | _ => true end.
Definition is_joined (l : law) (path : list waypoint) : bool :=
  match l with Geodesic => pairs turns_meet path | Lengths => pairs tubes_nest path | _ => true end.

(** The middle of a box, and all of it. *)
Definition middle_of (prec : F.precision) (start : Q) (b : box) : interval :=
  fraction prec (Qred ((start + upto b) * (1 # 2))).
Definition range_of (prec : F.precision) (start : Q) (b : box) : interval :=
  I.join (from_to prec start (upto b)) (middle_of prec start b).

Definition check_poses (prec : F.precision) (c : certificate) (m : machine) (q : poses_form) (start : Q) (b : box)
    : bool :=
  let x := middle_of prec start b in
  let S := range_of prec start b in
  check_pose prec (sub prec S x, radii prec m) m (tension_margin c) (length_margin c) b (q x S).

Definition check_box (prec : F.precision) (c : certificate) (q : motion_form) (start : Q) (b : box) : bool :=
  Qle_bool start (upto b) &&
  match q, tube b with
  | Explicit f, _ => check_poses prec c (subject c) f start b
  | Held v w, Some h =>
      let m := near_guess (subject c) v (within h) in
      is_exact (subject c) && has_tube v && no_half_turns w && below prec (angle_of prec m) (one prec) &&
      check_tube prec (subject c) v w (middle_of prec start b) (range_of prec start b) h &&
      check_poses prec c m (guess_form prec v w (guess h)) start b
  | Held _ _, None => false
  end.

(** Boxes from [start] have to reach 1; no box is no proof. *)
Fixpoint check_boxes (prec : F.precision) (c : certificate) (q : motion_form) (start : Q) (l : list box) : bool :=
  match l with
  | [] => false
  | [b] => Qeq_bool (upto b) 1 && check_box prec c q start b
  | b :: l => check_box prec c q start b && check_boxes prec c q (upto b) l
  end.

Fixpoint check_motions (prec : F.precision) (c : certificate) (l : list motion_form) (boxes : list (list box)) : bool :=
  match l, boxes with
  | [], [] => true
  | q :: l, b :: boxes => check_boxes prec c q 0 b && check_motions prec c l boxes
  | _, _ => false
  end.

Definition check (c : certificate) : bool :=
  let prec := F.PtoP (bits c) in
  let l := motions prec (subject c) (motion c) (path c) in
  match l with [] => false | _ => true end && is_joined (motion c) (path c) &&
  below prec (angle_of prec (subject c)) (one prec) && check_motions prec c l (boxes c).

End Checker.
