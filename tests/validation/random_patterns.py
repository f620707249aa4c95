#!/usr/bin/env python3
"""Draws sewing patterns at random, dresses the mannequin in each by `percale drape`, and says how each ended.

    tests/validation/random_patterns.py build/percale data/meshes/mannequin.obj build/random_patterns --count 50

Skirts, gathered skirts, T-shirts and trousers: sizes, curves, places of the panels, fabrics and edge lengths vary. Each ends
as one of

    dressed   exit code 0: sewn, at rest, proven free of crossings, where it was drawn
    slid      the same, but the program warns that it slid down: its waist is too wide for its fabric
    refused   exit code 2: wrong input
    reason    exit code 1 with the program's reason: a seam that stayed open, not at rest in time, fell off
    bad       crossings, a crash, no reason, or longer than --limit

Exit code 1 if one is bad, or if fewer than --dressed of them (a share) are dressed.
"""

import argparse
import concurrent.futures
import pathlib
import random
import re
import subprocess
import sys
import time

FABRICS = ["cotton", "silk", "wool", "denim", "ponte", "interlock_tshirt", "rib_knit"]


def points(corners):
    return "[" + ", ".join(f"[{x:.2f}, {y:.2f}]" for x, y in corners) + "]"


def panel(name, corners, at, turn=0.0, curves=(), mirror=None):
    text = f'[[panel]]\nname = "{name}"\npoints = {points(corners)}\nat = [{at[0]:.2f}, {at[1]:.2f}, {at[2]:.2f}]\n'
    if turn:
        text += f"turn = [0, {turn}, 0]\n"
    if curves:
        text += "curves = [" + ", ".join(f"{{ edge = {e}, bulge = {b:.2f} }}" for e, b in curves) + "]\n"
    if mirror:
        text += f'mirror = "{mirror}"\n'
    return text


def seam(name, one, other, gather=False):
    sides = ", ".join("[" + ", ".join(f'"{edge}"' for edge in side) + "]" for side in (one, other))
    return f'[[seam]]\nname = "{name}"\nsides = [{sides}]\n' + ("gather = true\n" if gather else "")


def skirt(draw):
    hem, hip, waist = draw.uniform(28, 46), draw.uniform(27, 32), draw.uniform(20, 25)
    low, top = draw.uniform(30, 75), draw.uniform(105, 110)
    outline = [(-hem, low), (hem, low), (hip, 88), (waist, top), (-waist, top), (-hip, 88)]
    bulge, far = draw.uniform(0, 6), draw.uniform(14, 20)
    front = panel("front", outline, (draw.uniform(-2, 2), 0, far), 0, [(0, bulge), (3, draw.uniform(-2, 0))])
    back = panel("back", outline, (draw.uniform(-2, 2), 0, -far), 180, [(0, bulge), (3, draw.uniform(-2, 0))])
    return [front, back, seam("left", ["front.1", "front.2"], ["back.4", "back.5"]),
            seam("right", ["front.4", "front.5"], ["back.1", "back.2"])]


def gathered_skirt(draw):
    """A band around the waist and a wider skirt gathered to it."""
    waist, ratio = draw.uniform(21, 25), draw.uniform(1.2, 2.0)
    band, top, low, far = draw.uniform(4, 8), draw.uniform(106, 110), draw.uniform(45, 75), draw.uniform(15, 20)
    strip = [(-waist, top - band), (waist, top - band), (waist, top), (-waist, top)]
    wide = waist * ratio
    flare = wide * draw.uniform(1.0, 1.2)
    sheet = [(-flare, low), (flare, low), (wide, top - band - 1), (-wide, top - band - 1)]
    parts = []
    for side, sign, turn in (("front", 1, 0), ("back", -1, 180)):
        parts.append(panel(f"{side}_band", strip, (0, 0, sign * far), turn))
        parts.append(panel(side, sheet, (0, 0, sign * (far + 2)), turn))
        parts.append(seam(f"{side} waist", [f"{side}_band.0"], [f"{side}.2"], gather=True))
    for name, one, other in (("left", 1, 3), ("right", 3, 1)):
        parts.append(seam(f"{name} band", [f"front_band.{one}"], [f"back_band.{other}"]))
        parts.append(seam(f"{name} side", [f"front.{one}"], [f"back.{other}"]))
    return parts


def t_shirt(draw):
    hem, low = draw.uniform(26, 34), draw.uniform(78, 108)
    sleeve, cuff, neck = draw.uniform(0.85, 1.3), draw.uniform(18, 23), draw.uniform(9, 13)
    # Sleeves run from the armpit and the shoulder's end along the arm, which is 40 degrees from the vertical.
    shoulder = (24, 150)
    outer = (shoulder[0] + 21 * sleeve, shoulder[1] - 21 * sleeve)
    inner = (outer[0] - 0.61 * cuff, outer[1] - 0.79 * cuff)
    pit = (min(draw.uniform(25, 31), inner[0] - 3), 117)
    right = [(hem, low), pit, inner, outer, shoulder, (neck, 156)]
    outline = [(-hem, low)] + right + [(-x, y) for x, y in reversed(right[1:])]
    far = draw.uniform(15, 20)
    front = panel("front", outline, (0, draw.uniform(-1, 1), far), 0, [(6, -draw.uniform(5, 11))])
    back = panel("back", outline, (0, draw.uniform(-1, 1), -far), 180, [(6, -draw.uniform(2, 5))])
    return [front, back, seam("left side", ["front.1", "front.2"], ["back.10", "back.11"]),
            seam("left shoulder", ["front.4", "front.5"], ["back.7", "back.8"]),
            seam("right side", ["front.10", "front.11"], ["back.1", "back.2"]),
            seam("right shoulder", ["front.7", "front.8"], ["back.4", "back.5"])]


def trousers(draw):
    ankle, knee_out, top = draw.uniform(15, 21), draw.uniform(25, 30), draw.uniform(103, 108)
    low, waist = draw.uniform(6, 45), draw.uniform(21, 25)
    front_in, back_in = draw.uniform(-6, -4), draw.uniform(-11, -8)
    front = [(-5, low), (ankle, low), (knee_out, 90), (waist, top), (0, top), (0, 88), (front_in, 78)]
    back = [(-10, low), (ankle - 2, low), (knee_out, 90), (waist, top), (1, top + 1), (0, 90), (back_in, 78)]
    far = draw.uniform(14, 18)
    parts = [panel("left_front", front, (7, 0, far), 0, [(5, -1.5)], "right_front"),
             panel("right_back", back, (-12, 0, -far - 2), 180, [(5, -3)], "left_back")]
    for name in ("left", "right"):
        parts.append(seam(f"{name} outside", [f"{name}_front.1", f"{name}_front.2"], [f"{name}_back.1", f"{name}_back.2"]))
        parts.append(seam(f"{name} inside", [f"{name}_front.6"], [f"{name}_back.6"]))
    for name in ("front", "back"):
        parts.append(seam(f"{name} middle", [f"left_{name}.4", f"left_{name}.5"], [f"right_{name}.4", f"right_{name}.5"]))
    return parts


KINDS = [skirt, gathered_skirt, t_shirt, trousers]


def pattern(seed, number):
    draw = random.Random(f"{seed} {number}")
    kind = KINDS[number % len(KINDS)]
    text = "\n".join([f'title = "{kind.__name__} {number}"', 'unit = "cm"', ""] + kind(draw))
    # Garments of 2 to 4 cm edges keep a gap that their seams can turn in.
    options = ["--fabric", draw.choice(FABRICS), "--edge-length", f"{draw.uniform(0.02, 0.035):.4f}", "--thickness", "0.004"]
    return kind.__name__, text, options


def end_of(code, output, errors):
    if code == 0:
        warnings = [line for line in output.splitlines() if "slid down" in line]
        return ("slid", warnings[0]) if warnings else ("dressed", "")
    reason = errors.strip().splitlines()[-1] if errors.strip() else ""
    if code == 2 and reason:
        return "refused", reason
    if code == 1 and reason and "not clean" not in reason:
        return "reason", reason
    return "bad", reason or f"exit code {code}"


def dress(program, body, folder, seed, number, limit):
    kind, text, options = pattern(seed, number)
    file = folder / f"{kind}_{number}.toml"
    file.write_text(text)
    command = [program, "drape", str(file), str(body), "-o", str(file.with_suffix(".obj"))] + options
    start = time.monotonic()
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
        end, reason = end_of(run.returncode, run.stdout, run.stderr)
        output = run.stdout
    except subprocess.TimeoutExpired:
        end, reason, output = "bad", f"took longer than {limit:g} s", ""
    rest = re.search(r"at rest, (\S+) s simulated", output)
    gap = re.search(r"largest gap (\S+) m", output)
    return {"garment": f"{kind} {number}", "options": " ".join(options[1:4:2]), "end": end,
            "rest_s": rest.group(1) if rest else "", "gap_mm": f"{1e3 * float(gap.group(1)):.2f}" if gap else "",
            "wall_s": f"{time.monotonic() - start:.1f}", "reason": reason}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("body")
    parser.add_argument("folder", type=pathlib.Path, help="where patterns and draped meshes go")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="one of them, by its number")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=600.0, help="wall seconds for one garment")
    parser.add_argument("--dressed", type=float, default=0.0, help="share that must be dressed")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    numbers = range(options.count) if options.only is None else [options.only]
    counts = {"dressed": 0, "slid": 0, "refused": 0, "reason": 0, "bad": 0}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        rows = pool.map(lambda n: dress(options.program, options.body, options.folder, options.seed, n, options.limit), numbers)
        for row in rows:
            counts[row["end"]] += 1
            print("{garment:20} {options:24} {end:8} {rest_s:>6} s  gap {gap_mm:>6} mm  {wall_s:>6} s wall  {reason}".format(**row),
                  flush=True)
    print(", ".join(f"{count} {end}" for end, count in counts.items()))
    return 1 if counts["bad"] or counts["dressed"] < options.dressed * len(numbers) else 0


if __name__ == "__main__":
    sys.exit(main())
