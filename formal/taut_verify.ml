(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* taut-verify CERTIFICATE BOXES: whether the checker that Coq has proved sound accepts a path.

   CERTIFICATE is a certificate of taut, BOXES what `taut formal --boxes` has written for it. The problem and the path
   are read from the certificate, and nothing but numbers of which nothing is assumed from BOXES. What is not proved in
   Coq, and has to be believed, is this file, the library Yojson, Zarith and GMP, and OCaml.

   A key that is not known is refused wherever a meaning could hang on it: in the problem and in the path. The words of
   the claim, digests and signatures are not looked at.
   docs/certificate-format.md says what they mean, Statement.v what is proved of them. *)

module Int = Z  (* Check has a Z of its own *)
open Check

exception Refused of string

let refuse place format = Printf.ksprintf (fun s -> raise (Refused (place ^ ": " ^ s))) format

(* ---- JSON ---- *)

type json = Yojson.Safe.t

let entries place : json -> (string * json) list = function
  | `Assoc l ->
      let names = List.map fst l in
      if List.length (List.sort_uniq compare names) < List.length names then refuse place "a key that is there twice";
      l
  | _ -> refuse place "expected an object"

(* An object of these keys and no others; [optional] ones may be missing. *)
let fields ?(optional = []) place keys json =
  let l = entries place json in
  List.iter (fun (k, _) -> if not (List.mem k keys || List.mem k optional) then refuse place "the unknown key '%s'" k)
    l;
  List.iter (fun k -> if not (List.mem_assoc k l) then refuse place "no key '%s'" k) keys;
  l

let get key l : json = List.assoc key l
let find key l : json option = List.assoc_opt key l
let is_empty : json -> bool = function `Null | `List [] -> true | _ -> false

let elements place ?count : json -> json list = function
  | `List l ->
      Option.iter (fun n -> if List.length l <> n then refuse place "expected %d elements" n) count;
      l
  | _ -> refuse place "expected a list"

let text place : json -> string = function `String s -> s | _ -> refuse place "expected a text"

let whole place : json -> Int.t = function
  | `Int n -> Int.of_int n
  | `Intlit s -> Int.of_string s
  | _ -> refuse place "expected a whole number"

(* ---- Numbers ---- *)

let most_digits = 1100
let fraction n d = { qnum = n; qden = d }
let is_digit c = c >= '0' && c <= '9'

(* Positions from [i] that [holds]. *)
let rec span holds s i = if i < String.length s && holds s.[i] then span holds s (i + 1) else i

let power_of base exponent n = if exponent >= 0 then fraction (Int.mul n (Int.pow base exponent)) Int.one
  else fraction n (Int.pow base (-exponent))

(* -0.0210, 1e-4 or -1/36 *)
let rational place s =
  let bad () = refuse place "expected a rational number, got '%s'" s in
  let n = String.length s in
  if n = 0 || n > most_digits then bad ();
  let start = if s.[0] = '-' then 1 else 0 in
  let signed z = if start = 1 then Int.neg z else z in
  let a = span is_digit s start in
  let whole_part = String.sub s start (a - start) in
  if a < n && s.[a] = '/' then begin
    let b = span is_digit s (a + 1) in
    if whole_part = "" || b = a + 1 || b < n then bad ();
    let d = Int.of_string (String.sub s (a + 1) (b - a - 1)) in
    if Int.sign d <= 0 then bad ();
    fraction (signed (Int.of_string whole_part)) d
  end else begin
    let b = if a < n && s.[a] = '.' then span is_digit s (a + 1) else a in
    let part = if b > a then String.sub s (a + 1) (b - a - 1) else "" in
    if whole_part ^ part = "" then bad ();
    let exponent =
      if b = n then 0
      else if s.[b] <> 'e' && s.[b] <> 'E' then bad ()
      else begin
        let c = if b + 1 < n && (s.[b + 1] = '-' || s.[b + 1] = '+') then b + 2 else b + 1 in
        let d = span is_digit s c in
        if d = c || d < n || d - c > 4 then bad ();
        let e = int_of_string ("0u" ^ String.sub s c (d - c)) in
        if e > 1000 then bad ();
        if s.[b + 1] = '-' then -e else e
      end in
    power_of (Int.of_int 10) (exponent - String.length part) (signed (Int.of_string (whole_part ^ part)))
  end

(* -0x1.8p+1 *)
let binary64 place s =
  let bad () = refuse place "expected a hexadecimal number, got '%s'" s in
  let is_hex c = is_digit c || (c >= 'a' && c <= 'f') in
  let n = String.length s in
  let start = if n > 0 && s.[0] = '-' then 1 else 0 in
  if n < start + 2 || n > 32 || String.sub s start 2 <> "0x" then bad ();
  let a = span is_hex s (start + 2) in
  let b = if a < n && s.[a] = '.' then span is_hex s (a + 1) else a in
  let part = if b > a then String.sub s (a + 1) (b - a - 1) else "" in
  let c = if b + 1 < n && (s.[b + 1] = '-' || s.[b + 1] = '+') then b + 2 else b + 1 in
  if a = start + 2 || b >= n || s.[b] <> 'p' || span is_digit s c < n || c >= n || n - c > 4 then bad ();
  let exponent = int_of_string ("0u" ^ String.sub s c (n - c)) in
  let exponent = if s.[b + 1] = '-' then -exponent else exponent in
  let mantissa = Int.of_string ("0x" ^ String.sub s (start + 2) (a - start - 2) ^ part) in
  power_of (Int.of_int 2) (exponent - (4 * String.length part)) (if start = 1 then Int.neg mantissa else mantissa)

let number place json = rational place (text place json)

(* ---- Expressions ---- *)

let rec nat n = if n = 0 then O else S (nat (n - 1))

let index_of name l =
  let rec from i = function [] -> None | x :: _ when x = name -> Some i | _ :: l -> from (i + 1) l in
  from 0 l

(* Powers repeat what they are of: an expression of more parts than this would take for ever. *)
let most_parts = 5000
let require_few_parts place e =
  let left = ref most_parts in
  let rec count e =
    decr left;
    if !left < 0 then refuse place "an expression of so many parts";
    match e with
    | Number _ | Pi | Param _ -> ()
    | Minus a | Sqrt a | Sin a | Cos a -> count a
    | Plus (a, b) | Sub (a, b) | Times (a, b) | Over (a, b) -> count a; count b in
  count e

type scope = { parameters : string list; constants : (string * q) list }

let expression scope place s =
  let n = String.length s in
  if n > 10000 then refuse place "an expression that is too long";
  let at = ref 0 in
  let bad what = refuse place "in '%s', character %d: expected %s" s (!at + 1) what in
  let rec skip () = if !at < n && s.[!at] = ' ' then (incr at; skip ()) in
  let next () = skip (); if !at < n then s.[!at] else '\000' in
  let take c = if next () <> c then bad (Printf.sprintf "'%c'" c) else incr at in
  let take_while holds = let i = !at in at := span holds s i; String.sub s i (!at - i) in
  let is_letter c = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c = '_' in
  let depth = ref 0 in
  let rec sum () =
    incr depth;
    if !depth > 200 then bad "fewer parentheses";
    let rec more e = match next () with
      | '+' -> incr at; let f = product () in more (Plus (e, f))
      | '-' -> incr at; let f = product () in more (Sub (e, f))
      | _ -> e in
    let e = more (product ()) in
    decr depth;
    e
  and product () =
    let rec more e = match next () with
      | '*' -> incr at; let f = signed () in more (Times (e, f))
      | '/' -> incr at; let f = signed () in more (Over (e, f))
      | _ -> e in
    more (signed ())
  and signed () = if next () = '-' then (incr at; Minus (signed ())) else power ()
  and power () =
    let base = primary () in
    if next () <> '^' then base
    else begin
      incr at;
      ignore (next ());
      match take_while is_digit with
      | "" -> bad "a whole number above 0"
      | digits when String.length digits > 2 || int_of_string ("0u" ^ digits) < 1 || next () = '^' ->
          bad "an exponent from 1 to 99, and no other behind it"
      | digits ->
          let rec times k = if k = 1 then base else Times (times (k - 1), base) in
          let e = times (int_of_string ("0u" ^ digits)) in
          require_few_parts place e;
          e
    end
  and primary () =
    let c = next () in
    if c = '(' then (take '('; let e = sum () in take ')'; e)
    else if is_digit c || c = '.' then begin
      let i = !at in
      ignore (take_while (fun c -> is_digit c || c = '.'));
      if !at < n && (s.[!at] = 'e' || s.[!at] = 'E') then begin
        incr at;
        if !at < n && (s.[!at] = '-' || s.[!at] = '+') then incr at;
        ignore (take_while is_digit)
      end;
      if !at < n && is_letter s.[!at] then bad "an operator";
      Number (rational place (String.sub s i (!at - i)))
    end
    else if is_letter c then begin
      let name = take_while (fun c -> is_letter c || is_digit c) in
      let call f = take '('; let e = sum () in take ')'; f e in
      match name with
      | "pi" -> Pi
      | "sqrt" -> call (fun e -> Sqrt e)
      | "sin" -> call (fun e -> Sin e)
      | "cos" -> call (fun e -> Cos e)
      | _ -> (
          match (index_of name scope.parameters, List.assoc_opt name scope.constants) with
          | Some i, None -> Param (nat i)
          | None, Some q -> Number q
          | _ -> bad "a name or a function that Coq is told")
    end
    else bad "a value" in
  let e = sum () in
  if next () <> '\000' || !at < n then bad "nothing more";
  require_few_parts place e;
  e

(* ---- The problem ---- *)

let vec place json = match elements place ~count:3 json with
  | [ x; y; z ] -> { vx = number place x; vy = number place y; vz = number place z }
  | _ -> assert false

let six place read json = match List.map read (elements place ~count:6 json) with
  | [ a; b; c; d; e; f ] -> { at1 = a; at2 = b; at3 = c; at4 = d; at5 = e; at6 = f }
  | _ -> assert false

let pair place json = match elements place ~count:2 json with
  | [ a; b ] -> (number place a, number place b)
  | _ -> assert false

let not_above x y = Int.leq (Int.mul x.qnum y.qden) (Int.mul y.qnum x.qden)

(* An empty set would be a load of which everything is true. *)
let ordered place json =
  let a, b = pair place json in
  if not (not_above a b) then refuse place "an interval that ends before it begins";
  (a, b)

let size place json =
  let x = number place json in
  if Int.sign x.qnum < 0 then refuse place "a size below 0";
  x

let set_of place l = match List.filter (fun (k, _) -> List.mem k [ "ball"; "disc"; "segment" ]) l with
  | [ ("ball", b) ] -> Ball (size place (get "radius" (fields place [ "radius" ] b)))
  | [ ("disc", d) ] ->
      let f = fields place [ "radius"; "normal" ] d in
      Disc (size place (get "radius" f), vec place (get "normal" f))
  | [ ("segment", s) ] ->
      let f = fields place [ "direction"; "range" ] s in
      let lower, upper = ordered place (get "range" f) in
      Along (vec place (get "direction" f), lower, upper)
  | _ -> refuse place "expected one set of vectors"

let axes_of place l = match text place (get "axes" l) with
  | "W" -> OfWorld
  | "P" -> OfPlatform
  | s -> refuse place "axes '%s'" s

let item gravity json =
  let place = "problem.load.items" in
  let sets = [ "ball"; "disc"; "segment" ] in
  match List.filter (fun (k, _) -> k <> "name") (entries place json) with
  | [ ("weight", w) ] ->
      let f = fields place [ "mass_kg"; "at_m"; "at_tolerance_m" ] w in
      let lower, upper = ordered place (get "mass_kg" f) in
      Weight (lower, upper, gravity, vec place (get "at_m" f), size place (get "at_tolerance_m" f))
  | [ ("force", w) ] ->
      let f = fields place [ "axes"; "at_m" ] ~optional:sets w in
      Force (set_of place f, axes_of place f, vec place (get "at_m" f))
  | [ ("moment", w) ] ->
      let f = fields place [ "axes" ] ~optional:sets w in
      Moment (set_of place f, axes_of place f)
  | [ ("load_cases", w) ] ->
      let f = fields place [ "wrenches"; "axes"; "at_m" ] w in
      let wrench json = match List.map (number place) (elements place ~count:6 json) with
        | [ a; b; c; d; e; f ] -> ({ vx = a; vy = b; vz = c }, { vx = d; vy = e; vz = f })
        | _ -> assert false in
      LoadCases (List.map wrench (elements place (get "wrenches" f)), axes_of place f, vec place (get "at_m" f))
  | _ -> refuse place "expected an item of one kind"

(* Tolerances but that of the ellipsoid's wrench, and that. *)
let tolerances json =
  let place = "problem.tolerances" in
  let zero = fraction Int.zero Int.one in
  let all x = { at1 = x; at2 = x; at3 = x; at4 = x; at5 = x; at6 = x } in
  if json = `Null then
    ({ of_anchors = all (zero, zero); of_load_point = zero; of_position = zero;
      of_orientation = Number zero }, all zero)
  else begin
    let f = fields place [ "base_anchor_m"; "platform_anchor_m"; "load_point_m"; "wrench"; "position_m";
                           "orientation_rad"; "cable_length_m" ] json in
    if get "cable_length_m" f <> `Null then refuse place "cables' lengths, which Coq is not told";
    let sizes key = six place (size place) (get key f) in
    let b = sizes "base_anchor_m" and p = sizes "platform_anchor_m" in
    ({ of_anchors = { at1 = (b.at1, p.at1); at2 = (b.at2, p.at2); at3 = (b.at3, p.at3); at4 = (b.at4, p.at4);
                      at5 = (b.at5, p.at5); at6 = (b.at6, p.at6) };
       of_load_point = size place (get "load_point_m" f);
       of_position = size place (get "position_m" f);
       of_orientation = expression { parameters = []; constants = [] } place (text place (get "orientation_rad" f)) },
     six place (number place) (get "wrench" f))
  end

let load shift json =
  let place = "problem.load" in
  let f = fields place [ "point_m" ] ~optional:[ "wrench"; "ellipsoid"; "ellipsoid_name"; "gravity_m_s2";
    "items" ] json in
  let ellipsoid = match (find "wrench" f, find "ellipsoid" f) with
    | Some w, Some e -> [ Ellipsoid (six place (number place) w, shift, six place (six place (number place)) e) ]
    | None, None -> []
    | _ -> refuse place "a wrench without an ellipsoid, or the other way round" in
  let items = match (find "items" f, find "gravity_m_s2" f) with
    | Some l, Some g -> List.map (item (vec place g)) (elements place l)
    | None, None -> []
    | _ -> refuse place "items without gravity, or the other way round" in
  if ellipsoid @ items = [] then refuse place "no load";
  (vec place (get "point_m" f), ellipsoid @ items)

let cables json =
  let place = "problem.robot" in
  let f = fields place [ "base_anchors_m"; "platform_anchors_m"; "tension_N"; "length_m" ] json in
  let each read key = List.map (read place) (elements place ~count:6 (get key f)) in
  let rec zip a b t l = match (a, b, t, l) with
    | a :: aa, b :: bb, t :: tt, l :: ll -> { base = a; platform = b; tension = t; length = l } :: zip aa bb tt ll
    | _ -> [] in
  match zip (each vec "base_anchors_m") (each vec "platform_anchors_m") (each pair "tension_N") (each pair "length_m")
    with
  | [ a; b; c; d; e; f ] -> { at1 = a; at2 = b; at3 = c; at4 = d; at5 = e; at6 = f }
  | _ -> refuse place "expected six cables"

(* The parameters' names, and the pose. What says which values are one pose, and in what range they stay, says nothing
   of which motions are feasible. *)
let space json =
  let place = "problem.space" in
  let f = fields place [ "parameters"; "constants"; "flip"; "pose"; "constraints" ] ~optional:[ "angles" ] json in
  if elements place (get "constraints" f) <> [] then refuse place "constraints, which Coq is not told";
  let name json = text place (get "name" (fields place [ "name"; "kind" ] ~optional:[ "range" ] json)) in
  let parameters = List.map name (elements place (get "parameters" f)) in
  let constants = List.map (fun (k, v) -> (k, number place v)) (entries place (get "constants" f)) in
  let names = parameters @ List.map fst constants in
  if List.length (List.sort_uniq compare names) < List.length names then refuse place "a name that is there twice";
  List.iter (fun n -> if List.mem n names then refuse place "the name '%s'" n) [ "pi"; "sqrt"; "sin"; "cos" ];
  let three kind = function [ a; b; c ] -> kind a b c | _ -> assert false in
  let kind, keys = match find "angles" f with
    | None -> (three (fun a b c -> TiltTorsion (a, b, c)), [ "phi"; "theta"; "sigma" ])
    | Some (`String "roll-pitch-yaw") -> (three (fun a b c -> RollPitchYaw (a, b, c)), [ "roll"; "pitch"; "yaw" ])
    | Some (`String "zyz") -> (three (fun a b c -> Zyz (a, b, c)), [ "alpha"; "beta"; "gamma" ])
    | Some (`Assoc _ as angles) ->
        let axis = vec place (get "axis" (fields place [ "axis" ] angles)) in
        ((function [ a ] -> About (axis, a) | _ -> assert false), [ "turn" ])
    | Some _ -> refuse place "angles that Coq is not told" in
  let pose = fields place ([ "px"; "py"; "pz" ] @ keys) (get "pose" f) in
  let value key = expression { parameters; constants } (place ^ ".pose." ^ key) (text place (get key pose)) in
  (parameters, { vx = value "px"; vy = value "py"; vz = value "pz" }, kind (List.map value keys))

(* ---- The path and the boxes ---- *)

let waypoint count json =
  let place = "path.waypoints" in
  let f = fields place [ "x"; "half_turns" ] json in
  let turns json =
    let n = whole place json in
    if not (Int.fits_int n) then refuse place "too many half turns";
    n in
  List.map2 (fun x h -> (binary64 place (text place x), turns h))
    (elements place ~count (get "x" f)) (elements place ~count (get "half_turns" f))

let numbers place key count f = List.map (fun x -> binary64 place (text place x)) (elements place ~count (get key f))
let no_half_turns = List.map (fun x -> (x, Int.zero))

(* Of a geodesic. *)
let pose json =
  let place = "path.waypoints" in
  let f = fields place [ "position"; "quaternion" ] json in
  no_half_turns (numbers place "position" 3 f @ numbers place "quaternion" 4 f)

(* Where lengths are straight: waypoints and the inner poses between them, each with its lengths, which are those of the
   segment there, and the tube that begins there. *)
let held waypoints tubes =
  let place = "path" in
  let add x y = fraction (Int.add (Int.mul x.qnum y.qden) (Int.mul y.qnum x.qden)) (Int.mul x.qden y.qden) in
  let mul x y = fraction (Int.mul x.qnum y.qnum) (Int.mul x.qden y.qden) in
  let between s x y = add x (mul s (add y (fraction (Int.neg x.qnum) x.qden))) in
  let waypoint json =
    let f = fields place [ "position"; "quaternion"; "lengths" ] json in
    (numbers place "position" 3 f @ numbers place "quaternion" 4 f, numbers place "lengths" 6 f) in
  let tube_of l = List.map (fun k -> binary64 place (text place (get k l))) [ "position"; "turn" ] in
  let inside json =
    let x = number place json in
    if Int.sign x.qnum <= 0 || Int.geq x.qnum x.qden then refuse place "a place that is not between 0 and 1";
    x in
  let segment (pose, first) (_, last) json =
    let f = fields place [ "position"; "turn" ] ~optional:[ "inner" ] json in
    let inner json =
      let f = fields place [ "position"; "quaternion"; "s"; "tube" ] json in
      (inside (get "s" f), numbers place "position" 3 f @ numbers place "quaternion" 4 f,
       tube_of (fields place [ "position"; "turn" ] (get "tube" f))) in
    let inner = List.map inner (Option.fold ~none:[] ~some:(elements place) (find "inner" f)) in
    if inner = [] && List.mem_assoc "inner" f then refuse place "no inner poses";
    let rec rise s = function
      | [] -> ()
      | (t, _, _) :: l -> if not_above t s then refuse place "inner poses that do not rise" else rise t l in
    rise (fraction Int.zero Int.one) inner;
    (pose @ first @ tube_of f) :: List.map (fun (s, pose, tube) -> pose @ List.map2 (between s) first last @ tube)
      inner in
  let rec all points tubes = match (points, tubes) with
    | [ (pose, lengths) ], [] -> [ pose @ lengths ]
    | a :: (b :: _ as rest), t :: tubes -> segment a b t @ all rest tubes
    | _ -> refuse place "expected a tube for each segment" in
  List.map no_half_turns (all (List.map waypoint waypoints) tubes)

let path count json =
  let place = "path" in
  let f = fields place [ "interpolation"; "waypoints" ] ~optional:[ "pose_tubes"; "tubes"; "times" ] json in
  let motion = match text place (get "interpolation" f) with
    | "straight-in-parameters" -> Straight
    | "cubic-b-spline" -> Spline
    | "geodesic" -> Geodesic
    | "straight-in-cable-lengths" -> Lengths
    | _ -> refuse place "a law that Coq is not told" in
  let empty k = if not (Option.fold ~none:true ~some:is_empty (find k f)) then refuse place "'%s'" k in
  empty "tubes";
  if motion <> Lengths then empty "pose_tubes";
  let waypoints = elements place (get "waypoints" f) in
  (motion, match motion with
    | Lengths -> held waypoints (Option.fold ~none:[] ~some:(elements place) (find "pose_tubes" f))
    | Geodesic -> List.map pose waypoints
    | Straight | Spline -> List.map (waypoint count) waypoints)

let scale_of place f =
  let scale = whole place (get "scale" f) in
  if Int.sign scale <= 0 || Int.gt scale (Int.of_int 1000) then refuse place "a scale out of range";
  scale

let inverse_of place f = six place (six place (whole place)) (get "inverse" f)

let tube_box json =
  let place = "boxes" in
  let f = fields place [ "scale"; "inverse"; "left"; "guess"; "within" ] json in
  { tube_scale = scale_of place f; tube_inverse = inverse_of place f; left = number place (get "left" f);
    guess = six place (number place) (get "guess" f); within = number place (get "within" f) }

let box json =
  let place = "boxes" in
  let f = fields place [ "upto"; "scale"; "inverse"; "densities" ] ~optional:[ "tube" ] json in
  { upto = number place (get "upto" f); scale0 = scale_of place f; inverse = inverse_of place f;
    densities = six place (whole place) (get "densities" f); tube = Option.map tube_box (find "tube" f) }

let certificate json boxes =
  let all = entries "certificate" json in
  if find "format" all <> Some (`String "taut-certificate") then refuse "certificate" "not a certificate of taut";
  if find "version" all <> Some (`Int 4) then refuse "certificate" "a version that Coq is not told: expected 4";
  if find "verdict" all <> Some (`String "proved") then refuse "certificate" "expected the verdict 'proved'";
  let f = fields "problem" [ "robot"; "load"; "space"; "query"; "name"; "tolerances" ] (get "problem" all) in
  let parameters, pose_position, pose_angles = space (get "space" f) in
  let tolerance, shift = tolerances (get "tolerances" f) in
  let load_point, load = load shift (get "load" f) in
  let is_zero x = Int.sign x.qnum = 0 in
  let of_load = [ tolerance.of_load_point; shift.at1; shift.at2; shift.at3; shift.at4; shift.at5; shift.at6 ] in
  let is_ellipsoid = function Ellipsoid _ -> true | _ -> false in
  if not (List.for_all is_ellipsoid load || List.for_all is_zero of_load) then
    refuse "problem.tolerances" "a tolerance of the load beside items, which have their own";
  let all_boxes = fields "boxes" [ "bits"; "boxes" ] boxes in
  let bits = whole "boxes" (get "bits" all_boxes) in
  if Int.sign bits <= 0 || Int.gt bits (Int.of_int 1000) then refuse "boxes" "bits out of range";
  let motion, path = path (List.length parameters) (get "path" all) in
  if motion = Lengths && get "tolerances" f <> `Null then
    refuse "problem.tolerances" "tolerances of a machine that holds lengths, which Coq is not told";
  let zero = fraction Int.zero Int.one in
  { subject = { cables = cables (get "robot" f); load_point; load; pose_position; pose_angles; tolerance };
    motion; path; tension_margin = zero; length_margin = zero; bits;
    boxes = List.map (fun l -> List.map box (elements "boxes" l)) (elements "boxes" (get "boxes" all_boxes)) }

(* ---- *)

let () =
  match Sys.argv with
  | [| _; file; boxes |] -> (
      try
        let read name = Yojson.Safe.from_file name in
        let c = certificate (read file) (read boxes) in
        if Exact.check c then
          Printf.printf
            "verified: everywhere along the path (%d %s%s), %sfor every machine and pose within the tolerances \
             and every wrench of the load, exactly one list of tensions balances it, and all tensions and all lengths \
             are strictly within their limits.\n\
             Not verified: how large margins are, that parameters stay in their ranges, that the path leads where the \
             query asked, and who signed.\n"
            (List.length c.boxes) (if c.motion = Lengths then "piece" else "segment")
            (if List.length c.boxes = 1 then "" else "s")
            (if c.motion = Lengths then "there is exactly one pose in its tube with its lengths, and there, " else "")
        else begin
          print_endline "REFUSED: the checker does not accept it with these boxes.";
          exit 1
        end
      with
      | Refused what -> prerr_endline ("taut-verify: " ^ what); exit 3
      | Yojson.Json_error what -> prerr_endline ("taut-verify: " ^ what); exit 3
      | Sys_error what -> prerr_endline ("taut-verify: " ^ what); exit 3
      | Not_found -> prerr_endline "taut-verify: a key is missing"; exit 3
      | Stack_overflow | Out_of_memory -> prerr_endline "taut-verify: nested too deep, or too large"; exit 3)
  | _ ->
      prerr_endline "usage: taut-verify CERTIFICATE BOXES (what 'taut formal --boxes' has written)";
      exit 3
