"""Runs on two wedges, shared by the rows of this chapter: worlds with the feet at other places, and figures from logs."""
import csv
import io
import math
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from rows import FOOTFALL, PROCESSES, ROOT, WANT, finish, give_up, run, scratch  # noqa: F401 (for the rows)

WORLDS = ROOT / "sim" / "worlds"

# Hume's legs (robots/hume/hume.xml), m: from the base to the hips, to the knee, to the ball's centre.
HIP_Y, HIP_Z = 0.1397, -0.03535
KNEE_X, KNEE_Z = 0.0181, -0.4575
SHANK = 0.44
RADIUS = 0.025
POSTURE = {"abduction": 0.0, "hip": math.radians(-27.92698), "knee": math.radians(57.17514)}
COM_X = 0.012  # of the CoM before the base in the worlds' start
HEIGHT = 0.785  # of the base above the balls' centres: hip joints at 0.75


def leg_angles(x, y, z, side):
    """Joint angles (abduction, hip, knee; rad) that put the ball's centre at x, y, z in the base frame; knee forward."""
    dy = y - side * HIP_Y
    down = math.hypot(dy, z)
    abduction = math.atan2(dy, -z)
    px, pz = x, -down - HIP_Z
    thigh = math.hypot(KNEE_X, KNEE_Z)
    reach = math.hypot(px, pz)
    bend = math.pi - math.acos((thigh**2 + SHANK**2 - reach**2) / (2 * thigh * SHANK))
    lean = math.atan2(-px, -pz)  # of the line to the ball, about y
    inner = math.acos((thigh**2 + reach**2 - SHANK**2) / (2 * thigh * reach))
    thigh_rest = math.atan2(-KNEE_X, -KNEE_Z)  # of the thigh at hip 0
    hip = lean - inner - thigh_rest
    knee = bend + thigh_rest
    return abduction, hip, knee


def world_text(base, shift=0.0, side=0.1397, apart=0.30, slope=45.0, extra=""):
    """A world over `base` with feet `apart` before and behind the V's middle and `side` to the sides, the base moved by
    `shift` along x from the middle."""
    middle = COM_X - shift
    lines = ["world: 1", f"base: {base}", "start:", "  joints:"]
    for name, sign, x in (("right", -1.0, apart), ("left", 1.0, -apart)):
        for joint, angle in zip(("abduction", "hip", "knee"), leg_angles(middle + x, sign * side, -HEIGHT, sign)):
            lines.append(f"    {name}_{joint}: {angle - POSTURE[joint]:.9f} rad")
    long, wide, high = 0.8, 1.0, 0.3
    lines += ["ground:", "  terrain:"]
    for sign in (1.0, -1.0):
        c, s = math.cos(math.radians(slope)), math.sin(math.radians(slope))
        at, top = middle + sign * 0.3, 0.3 * math.tan(math.radians(slope)) + 0.0
        lines.append(f"    - {{box: {{at: [{at:.6f} m, 0 m], size: [{long} m, {wide} m, {high} m], z: {top:.6f} m, "
                     f"pitch: {-sign * slope} deg}}}}")
    return "\n".join(lines) + "\n" + extra


def rows_of(behavior, world, seed, signals, *options):
    """(summary with the times of the fault `slip`, rows of the log) of one run, all ticks that are logged."""
    with scratch() as folder:
        where = ["--world", world] if world else []
        done = run(behavior, *where, "--seed", seed, "--log", folder, *options, log=True)
        text = subprocess.run([FOOTFALL, "export", folder, "--csv", "--signals", *signals], cwd=ROOT, capture_output=True,
                              text=True, check=True).stdout
        events = subprocess.run([FOOTFALL, "events", folder], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    done["slips"] = [float(line.split()[0]) for line in events.splitlines() if line.split()[2:4] == ["fault", "slip"]]
    return done, list(csv.DictReader(io.StringIO(text)))


def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else math.nan


def each(function, cases):
    """function(*case) for every case, two at a time, in order."""
    with ThreadPoolExecutor(PROCESSES) as pool:
        return list(pool.map(lambda case: function(*case), cases))


def largest(values):
    return max(values, default=math.inf)


def relative_error(rows, name="tension"):
    """rms of measured minus reference over the rms of the reference."""
    reference = rms(float(r[f"internal.{name}.reference"]) for r in rows)
    return rms(float(r[f"internal.{name}.measured"]) - float(r[f"internal.{name}.reference"]) for r in rows) / reference


def slid(rows):
    """Largest distance, m, of a foot's contact point from where it was in the first row."""
    place = lambda row, foot: [float(row[f"point.{foot}.{axis}"]) for axis in "xyz"]
    return largest(math.dist(place(row, foot), place(rows[0], foot)) for row in rows for foot in ("right_foot", "left_foot"))


def held_start(until):
    """Script entries: people hold the torso from the start, and let go."""
    return [f"{{at: 0 s, hold: torso, for: {until} s}}"]


def scenario_rows(behavior, world, seed, signals, script, duration, *options):
    """rows_of for a scenario with this script; `world`: a name, or the text of a world file."""
    with tempfile.TemporaryDirectory(prefix="footfall-wedges-") as folder:
        if "\n" in world:
            path = Path(folder) / "world.yaml"
            path.write_text(world)
            world = path
        scenario = Path(folder) / "scenario.yaml"
        lines = ["scenario: 1", f"behavior: {behavior}", f"world: {world}", f"for: {duration}", f"seeds: [{seed}]", "script:"]
        scenario.write_text("\n".join(lines + [f"  - {entry}" for entry in script] + ["expect: [{end: time}]"]) + "\n")
        return rows_of(str(scenario), None, seed, signals, *options)
