(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * The certificate: a statement, and the numbers by which it is proved *)

From Coq Require Import QArith List.
From Taut Require Import Statement.

(** Where a machine holds its cables' lengths: an approximate inverse of the derivative of half their squares by the
    coordinates in the tube, in multiples of 2^-[tube_scale]; how much is left, at most, of an error after one step of
    Newton's method with it; and coordinates near which the platform is, and within what distance. *)
Record tube_box := TubeBox { tube_scale : positive; tube_inverse : six (six Z); left : Q; guess : six Q; within : Q }.

(** A box is a part of a segment, from where the last box ended (or 0) to [upto]. [inverse] is an approximate inverse of
    the matrix with the columns (d ; lever x d), of which the columns of J are multiples by the cables' lengths, and
    [densities] are tensions divided by lengths of a wrench in the middle of the load; both are multiples of 2^-[scale].
    Nothing is assumed of these numbers. *)
Record box := Box { upto : Q; scale : positive; inverse : six (six Z); densities : six Z; tube : option tube_box }.

Record certificate := Certificate {
  subject : machine;
  motion : law;
  path : list waypoint;
  tension_margin : Q;
  length_margin : Q;
  bits : positive;                 (* the precision of the arithmetic, where it can be chosen *)
  boxes : list (list box)          (* one list a segment *)
}.

Definition statement (c : certificate) : Prop :=
  wrench_feasible (subject c) (motion c) (path c) (tension_margin c) (length_margin c).

(** A machine deviates by a vector in each of these balls: of the platform's position, of the turn of its axes, of the
    load point, and of each cable's anchors, at the base and at the platform. *)
Definition balls := 15%nat.
