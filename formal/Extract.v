(* SPDX-License-Identifier: GPL-3.0-or-later *)
(** * The checker over whole numbers as a program in OCaml *)

From Coq Require Import Reals Extraction ExtrOcamlBasic ExtrOcamlZBigInt.
From Taut Require Import Statement Verify.

Extract Constant Rdefinitions.RbaseSymbolsImpl.R => "unit".
Extract Constant Rdefinitions.RbaseSymbolsImpl.R0 => "()".
Extract Constant Rdefinitions.RbaseSymbolsImpl.R1 => "()".
Extract Constant Rdefinitions.RbaseSymbolsImpl.Rplus => "(fun _ _ -> assert false)".
Extract Constant Rdefinitions.RbaseSymbolsImpl.Rmult => "(fun _ _ -> assert false)".
Extract Constant Rdefinitions.RbaseSymbolsImpl.Ropp => "(fun _ -> assert false)".
Extract Constant Rdefinitions.RbaseSymbolsImpl.Rabst => "(fun _ -> assert false)".
Extract Constant Rdefinitions.RbaseSymbolsImpl.Rrepr => "(fun _ -> assert false)".
Extract Constant Rdefinitions.RinvImpl.Rinv => "(fun _ -> assert false)".
Extract Constant Rdefinitions.up => "(fun _ -> assert false)".
Extract Constant Rdefinitions.total_order_T => "(fun _ _ -> assert false)".
Extract Constant Rbasic_fun.Rabs => "(fun _ -> assert false)".
Extract Constant R_sqrt.sqrt => "(fun _ -> assert false)".
Extract Constant Rtrigo_def.cos => "(fun _ -> assert false)".
Extract Constant Rtrigo_def.sin => "(fun _ -> assert false)".
Extract Constant Rtrigo_def.exp => "(fun _ -> assert false)".
Extract Constant Ratan.atan => "(fun _ -> assert false)".
Extract Constant Rtrigo1.PI => "()".
Extract Constant Rpower.ln => "(fun _ -> assert false)".
Extraction "check.ml" Exact.check.
