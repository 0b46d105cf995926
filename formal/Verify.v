(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * Two instances of the checker: whole numbers without primitive types, and the processor's floating point *)

From Coq Require Import ZArith.
From Interval Require Import Float.Specific_ops Float.Specific_stdz Float.Primitive_ops.
From Taut Require Import Statement Certificate Soundness.

Module StdZ := SpecificFloat StdZRadix2.
Module Exact := Soundness.Soundness StdZ.
Module Fast := Soundness.Soundness PrimitiveFloat.

Print Assumptions Exact.check_sound.
Print Assumptions Fast.check_sound.
