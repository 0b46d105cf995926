# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans motions of cable-driven hexapods and proves them.

    import taut

    case = taut.Case.load("crane.yaml")
    certificate = taut.plan(case)
    print(certificate.verdict, certificate.theorem)
    certificate.save("certificate.json")

Every verdict comes from the independent checker: plan(), prove() and audit() run it before they return, and a
certificate that was loaded has no verdict until check() has proved it again.

Everything is in SI units and radians. Certificates are the same as those of the commands `taut plan` and `taut audit`,
byte for byte. All work releases the interpreter and is stopped by Ctrl-C. docs/library.md describes the whole library.
"""
from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _taut
from ._errors import InputError, InternalError, Interrupted, UntrustworthyMachine

__all__ = ["Case", "Certificate", "CheckResult", "InputError", "InternalError", "Interrupted", "Margins",
           "MovePlan", "Path", "Place", "Poses", "Samples", "Stretch", "Theorem", "TimeLaw", "UntrustworthyMachine",
           "Winches", "Witness", "audit", "check", "plan", "prove", "report", "sensitivity"]
__version__: str = _taut.version

Floats = NDArray[np.float64]
#: Called at most twenty times a second, in the calling thread, with the stage ("planning", "proving the move",
#: "auditing", "seeking provable shares" or "trying changes"), the number of charts, laws, segments, shares or changes
#: that are done, and their total (0: unknown). An exception that it raises ends the work and reaches the caller.
Progress = Callable[[str, int, int], Any]
FileName = Union[str, "os.PathLike[str]"]
#: Default time limit of the checker [s].
CHECK_SECONDS = 300.0
#: Default time limit for finding what stands in the way of a proof, or how far it reaches [s].
HEADROOM_SECONDS = 30.0
#: Default time limit for proving that no path exists, where the search found none [s].
NO_PATH_SECONDS = 10.0


# --- Cases and paths --------------------------------------------------------------------------------------------------

class Case:
    """A robot, its load, the space of its poses, and maybe a query (docs/case-format.md).

    :param source: the text of a case file (YAML), or a dict of the same form, which may have NumPy arrays for lists
    :param name: used instead of a file name in messages
    """

    def __init__(self, source: Union[str, Mapping[str, Any]], name: str = "case") -> None:
        text = source if isinstance(source, str) else json.dumps(source, default=_plain, ensure_ascii=False, indent=1)
        self._case = _taut.Case.parse(text, name)

    @classmethod
    def load(cls, file: FileName) -> Case:
        """Reads a case file."""
        return cls._of(_taut.Case.load(os.fspath(file)))

    @classmethod
    def _of(cls, case: Any) -> Case:
        result = cls.__new__(cls)
        result._case = case
        return result

    @property
    def name(self) -> str:
        return self._case.name

    @property
    def document_fields(self) -> dict[str, str]:
        """What the case states for the head of a report: title, machine, site, load_name, document, prepared_by.

        Nothing checks it."""
        return dict(self._case.document_fields)

    @property
    def description(self) -> str:
        """The file's leading comment."""
        return self._case.description

    @property
    def parameters(self) -> list[str]:
        """The parameters' names, in the order of a waypoint's columns."""
        return self._case.parameters

    @property
    def query_waypoints(self) -> int:
        """Number of waypoints of the query; 0: there is nothing to plan, or there are legs."""
        return self._case.query_waypoints

    @property
    def legs(self) -> dict[str, Case]:
        """The legs of a case of legs, by name and in their order, each a case of its own. Empty for any other case."""
        return {name: Case._of(leg) for name, leg in self._case.legs}

    @property
    def tension_limits_N(self) -> Floats:
        """Lower and upper limit of each cable, (6, 2), rounded: for plots."""
        return self._case.tension_limits_N

    @property
    def length_limits_m(self) -> Floats:
        """Lower and upper limit of each cable, (6, 2), rounded: for plots."""
        return self._case.length_limits_m

    @property
    def bodies_statement(self) -> list[str]:
        """What may not touch what, as it was understood, in m, mm and degrees, a sentence each.

        Empty where the case states no bodies: then nothing is proved of collisions.
        """
        return self._case.bodies_statement

    @property
    def load_statement(self) -> list[str]:
        """The load as it was understood, in kg, t, N, kN, N m and m, a sentence each, as `taut show` prints it.

        Read it before you rely on a verdict: a slip of units shows there. Its numbers are summary_data()["load"].
        """
        return self._case.load_statement

    @property
    def time_statement(self) -> str:
        """What winches and load may do in time, as it was understood.

        Empty where the case does not limit it: then its plans are paths that are passed slowly.
        """
        return self._case.time_statement

    @property
    def warnings(self) -> list[str]:
        """What may not be meant as it was typed, each with its place: what the commands print as warnings."""
        return self._case.warnings

    def summary(self) -> str:
        """How the case was understood, as `taut show` prints it.

        It has tensions, lengths and margins at the query's waypoints, in floating point; nothing is proved here.
        """
        return self._case.summary()

    def summary_data(self) -> dict[str, Any]:
        """The summary as Python types, in SI units."""
        return json.loads(self._case.summary_json())

    def drawing_svg(self) -> str:
        """The robot at the query's first waypoint, an SVG document."""
        return self._case.drawing_svg()

    def _repr_svg_(self) -> Optional[str]:
        """How notebooks show a case."""
        return self.drawing_svg() if self.query_waypoints or self.legs else None

    def __repr__(self) -> str:
        return f"<taut.Case {self.name!r}, parameters {', '.join(self.parameters)}>"


@dataclasses.dataclass(frozen=True, eq=False)
class TimeLaw:
    """When a move is where on its path: a uniform cubic B-spline of time, whose values count segments.

    It never falls, and runs from 0 to the number of segments, exactly (docs/certificate-format.md).
    """
    step_s: float     #: between knots [s]
    controls: Floats  #: (n,): three more than pieces of the law; 4 to 20,000

    @property
    def duration_s(self) -> float:
        """How long the move takes, rounded."""
        return self.step_s * max(len(self.controls) - 3, 0)


@dataclasses.dataclass(frozen=True, eq=False)
class Path:
    """Waypoints, bit for bit, and the law between them: "straight", "spline", "geodesic" or "cable-lengths"."""
    interpolation: str
    waypoints: Floats                      #: (n, columns), see prove()
    half_turns: Optional[NDArray[np.intc]] #: (n, columns): parameters are waypoints + π half_turns; None for poses
    times: tuple[str, ...]                 #: decimals [s]; may be empty
    timing: Optional[TimeLaw] = None       #: of a move in time (docs/moves.md); None: the path is passed slowly

    @property
    def parameters(self) -> Floats:
        """waypoints + π half_turns, rounded."""
        return self.waypoints if self.half_turns is None else self.waypoints + np.pi * self.half_turns


# --- Certificates -----------------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True)
class Margins:
    """Proved lower bounds, rounded down. Those of a move are with the load's inertia, at every time."""
    tension_N: float     #: every tension stays at least this far inside its limits, for every wrench
    length_m: float      #: every length stays at least this far inside its limits
    wrench_scale: float  #: the ellipsoid of wrenches could be larger by this factor; 1 of a move
    clearance_m: Optional[float]  #: bodies are farther apart than their clearances by this; None: no pair is checked


@dataclasses.dataclass(frozen=True)
class Place:
    """A point of a path: a waypoint, or the point s of a segment."""
    index: int
    s: Optional[float]  #: from 0 to 1; None: a waypoint

    @property
    def position(self) -> float:
        """index + s, comparable with Samples.position."""
        return self.index + (self.s or 0.0)


@dataclasses.dataclass(frozen=True)
class Witness:
    """A proved violation."""
    #: "tension_min", "tension_max", "length_min", "length_max", "singular" or "contact"; of a move also what is too
    #: fast, "winch_speed", "winch_acceleration", "winch_power", "load_speed", "load_acceleration",
    #: "load_angular_speed" or "load_angular_acceleration"
    kind: str
    at: Place
    to: Optional[Place]                    #: of "singular", which is between `at` and `to`; the next three are None
    cable: Optional[int]                   #: 1 to 6; None of the load
    value: Optional[tuple[float, float]]   #: the tension [N], length [m] or rate [SI] lies between these two
    limit: Optional[float]
    deviates: bool                         #: the machine is not the stated one, but within the case's tolerances
    #: of a move that may be slowed down: at which share of its speed it is run there, and -1 where it is braked as hard
    #: as the stopping time allows, 1 where it speeds up as fast; None: as its law says
    slowing: Optional[tuple[float, int]]
    bodies: Optional[tuple[str, str]]      #: of "contact", which has no cable, value or limit: two that are too near,
    depth_m: Optional[float]               #: by at least so much


@dataclasses.dataclass(frozen=True)
class Theorem:
    """What the independent checker has proved."""
    verdict: str                 #: "proved", "refuted" or "no path"
    claim: str                   #: in words
    margins: Optional[Margins]   #: only if proved
    witness: Optional[Witness]   #: only if refuted; the gravest that was found
    certificate_sha256: str      #: of the text of the certificate that was proved


@dataclasses.dataclass(frozen=True)
class Stretch:
    """A stretch of an audited path that is not proved."""
    begin: Place                                     #: a refuted path is proved outside of its stretches
    end: Place
    violations: Optional[tuple[Witness, Witness]]    #: the first and the last proved violation; None: it is open
    reason: str                                      #: why it is open; empty if there are violations
    reason_code: str                                 #: "U5": `taut explain` explains it; may be empty


@dataclasses.dataclass(frozen=True, eq=False)
class Samples:
    """Poses of a path in floating point, for plots. Nothing here is proved.

    Those of a move are equally spaced in time, with the tensions that the load's inertia makes of them.
    """
    position: Floats         #: (n,): k + s is the point s of segment k
    p_m: Floats              #: (n, 3)
    quaternion: Floats       #: (n, 4): x, y, z, w
    tension_lower_N: Floats  #: (n, 6) over all wrenches of the ellipsoid; NaN where the pose is singular
    tension_upper_N: Floats  #: (n, 6)
    length_m: Floats         #: (n, 6)
    time_s: Optional[Floats] = None  #: (n,) of a move


@dataclasses.dataclass(frozen=True, eq=False)
class Winches:
    """A proved move in time, for the drives that follow it; in floating point."""
    time_s: Floats              #: (n,)
    length_m: Floats            #: (n, 6)
    speed_m_s: Floats           #: (n, 6): of the lengths
    acceleration_m_s2: Floats   #: (n, 6)
    least_tension_N: Floats     #: (n, 6): of all places from the row to the next, all loads and deviations, as proved
    greatest_tension_N: Floats  #: (n, 6): likewise


@dataclasses.dataclass(frozen=True, eq=False)
class Poses:
    """A proved move in time; in floating point."""
    time_s: Floats      #: (n,)
    p_m: Floats         #: (n, 3)
    quaternion: Floats  #: (n, 4): x, y, z, w


@dataclasses.dataclass(frozen=True)
class MovePlan:
    """How plan() made a move; nothing of this is in the certificate.

    Shares are of the speed of the law that was proved first.
    """
    planned_s: float            #: how long that law takes
    speed_share: float          #: at which the move runs
    fastest_s: Optional[float]  #: the fastest law without a limit of jerk, in floating point; if one was found
    tries: int                  #: laws that were to be proved
    #: where the greatest speed was sought: the smallest share that was refuted, if any, and what is violated then
    refuted_share: Optional[float]
    witness: Optional[Witness]


class Certificate:
    """A claim with everything that is needed to prove it again (docs/certificate-format.md).

    Loading or parsing a certificate only verifies its digest. The certificate is then unchecked, unless it claims
    nothing; check() says whether its claim is true.
    """

    def __init__(self, text: Union[str, bytes], name: str = "certificate") -> None:
        self._certificate = _taut.Certificate.parse(text, name)

    @classmethod
    def _of(cls, certificate: Any) -> Certificate:
        result = cls.__new__(cls)
        result._certificate = certificate
        return result

    @classmethod
    def load(cls, file: FileName) -> Certificate:
        """Reads certificate.json. Raises InputError if the file is not a certificate, or was cut or altered."""
        return cls._of(_taut.Certificate.load(os.fspath(file)))

    def save(self, file: FileName) -> None:
        """Writes the whole file or, if that fails, nothing."""
        self._certificate.save(os.fspath(file))

    @property
    def text(self) -> str:
        """The content of a file with this certificate, byte for byte: JSON."""
        return self._certificate.text

    @property
    def data(self) -> dict[str, Any]:
        """The certificate as Python types."""
        return json.loads(self.text)

    @property
    def theorem(self) -> Optional[Theorem]:
        """What the checker proved when plan(), prove() or audit() made this text; None for a loaded certificate."""
        return _theorem(self._certificate.theorem)

    @property
    def verdict(self) -> str:
        """The theorem's verdict, "proved", "refuted" or "no path"; without one "undecided" (not unsafe) or "unchecked".
        """
        return self._certificate.verdict

    @property
    def is_proved(self) -> bool:
        return self.verdict == "proved"

    @property
    def case_name(self) -> str:
        return self._certificate.case_name

    @property
    def document_fields(self) -> dict[str, str]:
        """As Case.document_fields, from the certificate's illustration: free text, no part of the claim."""
        return dict(self._certificate.document_fields)

    @property
    def stretches(self) -> list[Stretch]:
        """Stretches of an audited path that are not proved; empty if the certificate is unchecked."""
        return [Stretch(Place(*begin), Place(*end), violations and tuple(map(_witness, violations)), reason, code)
                for begin, end, violations, reason, code in self._certificate.stretches]

    @property
    def reason(self) -> str:
        """Why the certificate is undecided; empty otherwise."""
        return self._certificate.reason

    @property
    def reason_code(self) -> str:
        """The code of the reason, such as "U5", which `taut explain` explains; may be empty."""
        return self._certificate.reason_code

    @property
    def no_path_from(self) -> Optional[int]:
        """Of a certificate that no path exists: the waypoint of the query from which no motion leads to the next.

        Such a certificate has no path, no segments and no samples.
        """
        return self._certificate.no_path_from

    @property
    def headroom(self) -> Optional[dict[str, Any]]:
        """What stands in the way of a proof, or how far it reaches (docs/sensitivity.md); None where it was not sought.
        For legs, what is provable in all of them.

        The program that wrote the certificate says so; it is no part of the claim, and nothing checks it.
        """
        text = self._certificate.headroom
        return json.loads(text) if text else None

    @property
    def legs(self) -> dict[str, Certificate]:
        """The legs of a certificate of legs, by name and in their order, each a certificate of its own, with a theorem
        where there is one of it. Empty for any other certificate.

        A certificate of legs has no path, samples, margins or witness: its legs have.
        """
        return {name: Certificate._of(leg) for name, leg in self._certificate.legs}

    @property
    def path(self) -> Path:
        interpolation, waypoints, half_turns, times, timing = self._certificate.path
        law = timing and TimeLaw(timing[0], np.array(timing[1]))
        return Path(interpolation, waypoints, half_turns, tuple(times), law)

    @property
    def duration_s(self) -> Optional[float]:
        """How long the move takes, or all legs together; None of a path without a law in time."""
        return self._certificate.duration_s

    @property
    def move_plan(self) -> Optional[MovePlan]:
        """How plan() made the move; None of what it did not make, and of a certificate that was loaded."""
        plan = self._certificate.move_plan
        return plan and MovePlan(**{**plan, "witness": _witness(plan["witness"])})

    @property
    def path_csv(self) -> str:
        """The path as `taut plan` writes it, for the machine that will follow it."""
        return self._certificate.path_csv

    def controller_csv(self, step: float = 0.01) -> str:
        """The proved path as a dense table of poses and cable lengths, as `taut plan` writes it for a controller.

        :param step: [m]; from row to row neither the platform's origin nor a cable's end on it travels further
        :raises InputError: unless the certificate has a theorem that the path is proved
        """
        return self._certificate.controller_csv(step)

    def winches(self, rate: float = 100.0) -> Winches:
        """Lengths, speeds, accelerations and proved tensions of the cables of a move in time (docs/moves.md).

        Rows are at t = 0, 1/rate, 2/rate, … and where the move ends. They are on the move but for rounding; what drives
        do between them is proved where the case says so (`between_rows`). For legs, times go on from leg to leg.

        :param rate: rows a second, up to 10,000
        :raises InputError: unless the certificate has a theorem that a move is proved
        """
        rows = self._certificate.winches(rate)
        return Winches(rows[:, 0], rows[:, 1:7], rows[:, 7:13], rows[:, 13:19], rows[:, 19:25], rows[:, 25:])

    def poses(self, rate: float = 100.0) -> Poses:
        """The same rows as poses."""
        rows = self._certificate.poses(rate)
        return Poses(rows[:, 0], rows[:, 1:4], rows[:, 4:])

    def winches_csv(self, rate: float = 100.0) -> str:
        """winches.csv, as `taut plan` writes it at this rate; see winches()."""
        return self._certificate.winches_csv(rate)

    def poses_csv(self, rate: float = 100.0) -> str:
        """poses.csv, likewise."""
        return self._certificate.poses_csv(rate)

    def poses_tum(self, rate: float = 100.0) -> str:
        """poses.tum, likewise, for programs that compare trajectories."""
        return self._certificate.poses_tum(rate)

    @property
    def segments(self) -> int:
        return self._certificate.segments

    @property
    def boxes(self) -> int:
        """Number of boxes of the proof; if no path exists, of cells without a feasible pose."""
        return self._certificate.boxes

    def samples(self, about: int = 200) -> Samples:
        """About this many poses along the path, in order, including both ends."""
        return Samples(**self._certificate.samples(about))

    def __reduce__(self):
        return Certificate, (self.text,)

    def __repr__(self) -> str:
        return f"<taut.Certificate {self.verdict}, of {self.case_name!r}, {self.segments} segments>"


# --- What taut does ---------------------------------------------------------------------------------------------------

def plan(case: Case, *, budget_seconds: float = 0.0, atlas: Optional[FileName] = None,
         save_atlas: Optional[FileName] = None, grow: bool = False, signing_key: str = "",
         max_check_seconds: float = CHECK_SECONDS, headroom_seconds: float = HEADROOM_SECONDS,
         no_path_seconds: float = NO_PATH_SECONDS, speed_share: float = 1.0, greatest_speed: bool = False,
         progress: Optional[Progress] = None) -> Certificate:
    """Plans through the case's query and proves the path: `taut plan`. In a case with the key `time` it is a move.

    Where the search finds no path, it tries to prove that none exists: then the verdict is "no path". A case of legs
    has one certificate over all legs; time limits are for each leg, and that no path exists is not tried to prove.

    :param budget_seconds: time limit for planning and proving; 0: the case's own
    :param atlas: file with charts to begin with (docs/atlas-file.md)
    :param save_atlas: file into which all charts are written
    :param grow: make all charts that can be reached before they are saved
    :param signing_key: PEM of an Ed25519 private key that signs the certificate
    :param max_check_seconds: time limit of the checker, after which the certificate is unchecked
    :param headroom_seconds: time limit for Certificate.headroom; 0: it is not sought
    :param no_path_seconds: time limit for proving that no path exists; 0: that is not tried
    :param speed_share: run a move at this share of the planned speed, from 0.001 to 1, or slower where that is not
        proved
    :param greatest_speed: run a move's law as fast as that is proved, and seek what stands in the way of more
    """
    return Certificate._of(_taut.plan(case._case, budget_seconds, _file(atlas), _file(save_atlas), grow, signing_key,
                                      max_check_seconds, headroom_seconds, no_path_seconds, speed_share,
                                      greatest_speed, progress))


def prove(case: Case, waypoints: Union[ArrayLike, Path], *, interpolation: Optional[str] = None,
          half_turns: Optional[ArrayLike] = None, times: Sequence[Union[float, str]] = (),
          timing: Optional[TimeLaw] = None, max_bits: int = 4096, signing_key: str = "",
          max_check_seconds: float = CHECK_SECONDS) -> Certificate:
    """Proves a path of yours, bit for bit.

    Stops at the first violation found, or at the first piece that is undecided; audit() reports all of them.

    :param waypoints: a Path, or (n, columns); the columns are
        "straight" (the default)  the case's parameters, which go from value to value at constant rates
        "spline"         the case's parameters, as control points of a cubic B-spline
        "geodesic"       px, py, pz [m], qx, qy, qz, qw: the origin moves straight, the platform turns about one axis
        "cable-lengths"  the same, and l1 … l6 [m]; several poses may have these lengths, and the given pose, which is
                         refined, selects one
    :param half_turns: (n, columns): parameters are exactly waypoints + π half_turns; only for periodic parameters
    :param times: [s], ascending; not part of any claim
    :param timing: proves a move in time, in a case with the key `time`; but for splines it rests at each waypoint.
        None: the path is passed slowly
    """
    if isinstance(waypoints, Path):
        if interpolation is not None or half_turns is not None or len(times) > 0 or timing is not None:
            raise TypeError("a Path has its interpolation, half_turns, times and timing itself")
        interpolation, half_turns, times = waypoints.interpolation, waypoints.half_turns, waypoints.times
        waypoints, timing = waypoints.waypoints, waypoints.timing
    x = _floats(waypoints, "waypoints")
    turns = None
    if half_turns is not None:
        turns = np.ascontiguousarray(np.asarray(half_turns).astype(np.intc, casting="same_kind"))
        if turns.shape != x.shape:
            raise InputError(f"half_turns: got the shape {turns.shape}, expected that of the waypoints, {x.shape}",
                             field="half_turns")
    law = None
    if timing is not None:
        law = (timing.step_s, np.asarray(timing.controls).astype(np.float64, casting="safe"))
    return Certificate._of(_taut.prove(case._case, interpolation or "straight", x, turns, [_decimal(t) for t in times],
                                       law, max_bits, signing_key, max_check_seconds))


def audit(case: Case, path: Union[None, FileName, Mapping[str, ArrayLike], ArrayLike] = None, *,
          columns: Optional[Sequence[str]] = None, interpolation: Optional[str] = None,
          max_bits: int = 4096, signing_key: str = "", name: str = "table",
          max_check_seconds: float = CHECK_SECONDS, headroom_seconds: float = HEADROOM_SECONDS,
          timed: bool = False, rounding: Union[tuple[float, float], float, None] = None,
          progress: Optional[Progress] = None) -> Certificate:
    """Proves a path, or lists every stretch that is not proved, with the reason: `taut audit`.

    The path is passed slowly, also where the case limits moves, unless it is audited in time.

    :param path: a path file or a certificate.json (docs/audits.md); None: the one that the case names; a mapping from
        columns to arrays, {"phi[deg]": …, "theta[deg]": …}; or an array (n, columns)
    :param columns: names and units of an array's columns, "phi[deg]", "px[m]", "qw" (docs/audits.md)
    :param interpolation: "straight", "geodesic" or "cable-lengths"; None: as the file suggests
    :param name: name of a table, for messages and the certificate
    :param headroom_seconds: time limit for Certificate.headroom; 0: it is not sought
    :param timed: audit a move in time: a certificate's path with its law, or a move that is fitted to a table with
        times. There are no stretches then, and no headroom.
    :param rounding: how far rows of such a table may be from the move: of poses by (metres, radians), of cable lengths
        by metres; None: the case's own
    """
    if path is None or isinstance(path, (str, os.PathLike)):
        if columns is not None:
            raise TypeError("columns are an array's: a file has its own")
        file = None if path is None else os.fspath(path)
        return Certificate._of(_taut.audit_file(case._case, file, interpolation, max_bits, signing_key,
                                                max_check_seconds, headroom_seconds, timed, rounding, progress))
    if isinstance(path, Mapping):
        if columns is not None:
            raise TypeError("columns are an array's: a mapping has its own")
        columns = list(path)
        path = np.column_stack([np.asarray(values) for values in path.values()]) if columns else np.empty((0, 0))
    if columns is None:
        raise TypeError("columns are missing: what the array's columns mean")
    values = _floats(path, "values")
    if values.shape[1] != len(columns):
        raise InputError(f"values: got {values.shape[1]} columns, expected {len(columns)}", field="values")
    return Certificate._of(_taut.audit_table(case._case, list(columns), values, name, interpolation,
                                             max_bits, signing_key, max_check_seconds, headroom_seconds, timed,
                                             rounding, progress))


def sensitivity(case: Case, path: Optional[FileName] = None, *, interpolation: Optional[str] = None,
                budget_seconds: float = 60.0, progress: Optional[Progress] = None) -> dict[str, Any]:
    """What to change so that the path is proved: `taut sensitivity`. For the dict see docs/sensitivity.md.

    :param path: a path file; None: the path that the case names, else a plan; where none is found, the straight way
        through the query's waypoints
    :param interpolation: as in audit()
    :param budget_seconds: time limit of what follows the plan
    """
    file = None if path is None else os.fspath(path)
    found: dict[str, Any] = json.loads(_taut.sensitivity(case._case, file, interpolation, budget_seconds, progress))
    return found


@dataclasses.dataclass(frozen=True)
class CheckResult:
    #: "accepted", "rejected", "undecided" (the certificate claims nothing), "unchecked" or "malformed"
    outcome: str
    message: str      #: one line
    theorem: Optional[Theorem]  #: present if and only if accepted
    signer: str       #: public key whose signature was verified, 64 hex digits, or empty
    is_trusted: bool  #: whether the signer is one of the trusted keys
    segments: int
    boxes: int
    not_compared: tuple[str, ...]  #: "case", "path file", and what of the case does not matter to an audit

    @property
    def is_accepted(self) -> bool:
        """Also true of a refuted certificate whose refutation holds: see theorem.verdict."""
        return self.outcome == "accepted"


def check(certificate: Union[Certificate, bytes, FileName], case: Optional[Case] = None, *,
          trusted_keys: Sequence[str] = (), max_seconds: Optional[float] = None) -> CheckResult:
    """Proves a certificate again, by the independent checker, like `taut-check`.

    :param certificate: a Certificate, the bytes of one, or a file
    :param case: the case that the certificate must be about, to the last digit
    :param trusted_keys: PEMs of Ed25519 public keys, one of which must have signed the certificate
    :param max_seconds: time limit; None: no limit
    """
    if isinstance(certificate, Certificate):
        text = certificate.text.encode()
    elif isinstance(certificate, bytes):
        text = certificate
    else:
        with open(certificate, "rb") as file:
            text = file.read()
    result = _taut.check(text, case and case._case, list(trusted_keys), max_seconds)
    outcome, message, theorem, *rest, not_compared = result
    return CheckResult(outcome, message, _theorem(theorem), *rest, tuple(not_compared))


def report(certificate: Certificate, format: str = "html", *, document: str = "", revision: str = "", date: str = "",
           max_check_seconds: float = CHECK_SECONDS) -> str:
    """A page for people, made from the certificate alone: `taut report`.

    The checker first proves the certificate again, unless it has a theorem already. Raises InputError if the checker
    rejects it.

    :param format: "html", "text", "markdown" or "json"
    :param max_check_seconds: time limit of the checker, after which the page is headed UNCHECKED
    """
    return _taut.report(certificate._certificate, format, document, revision, date, max_check_seconds)


# --- Inside -----------------------------------------------------------------------------------------------------------

def _plain(value: Any) -> Any:
    """Converts NumPy's arrays and scalars to lists and numbers."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"a case can't hold a {type(value).__name__}")


def _floats(values: Any, what: str) -> Floats:
    array = np.asarray(values)
    if array.ndim != 2:
        raise InputError(f"{what}: got the shape {array.shape}, expected a row for each waypoint", field=what)
    return np.ascontiguousarray(array.astype(np.float64, casting="safe"))  # refuses types that would be rounded


def _decimal(time: Union[float, str]) -> str:
    return time if isinstance(time, str) else repr(float(time))


def _file(name: Optional[FileName]) -> str:
    return "" if name is None else os.fspath(name)


def _theorem(theorem: Optional[tuple[Any, ...]]) -> Optional[Theorem]:
    if theorem is None:
        return None
    verdict, claim, margins, witness, sha256 = theorem
    return Theorem(verdict, claim, margins and Margins(*margins), _witness(witness), sha256)


def _witness(witness: Optional[dict[str, Any]]) -> Optional[Witness]:
    if witness is None:
        return None
    places = {"at": Place(*witness["at"]), "to": witness["to"] and Place(*witness["to"])}
    return Witness(**{**witness, **places})
