# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs the paths of both tools. For each path without a partner a referee independent of both finds the
reason."""
import collections
import json

import numpy as np

import sionna_cfr
import sionna_setup
import sionna_wedge
from sionna_greatx import Greatx
from sionna_match import differences, pair
from sionna_paths import CASES, case_called
from sionna_referee import Referee
from sionna_side import Sionna, scene_file

# Searches for a path that Sionna RT did not find. The settings that find the path explain why it was missing.
SEARCHES = [
    ("another seed", {"seed": 7}),
    ("10 x the rays", {"samples": 1e7}),
    ("10 x the rays, 10 x the hash table", {"samples": 1e7, "table": 1e7}),
]


def report(text=""):
    print(text, flush=True)


def why_missing(sionna, case, receivers, missing, options):
    """Returns, by position in `missing`, the first of SEARCHES that finds each path."""
    reasons = {}
    for name, settings in SEARCHES:
        left = [i for i in range(len(missing)) if i not in reasons]
        for r in sorted({missing[i].receiver for i in left}):
            found = (
                sionna.paths([receivers[r]], first=r, samples=options.samples)
                if not settings
                else sionna.paths([receivers[r]], first=r, **({"samples": options.samples} | settings))
            )
            mine = [i for i in left if missing[i].receiver == r]
            _, still, _, _ = pair([missing[i] for i in mine], found)
            for i in mine:
                if not any(missing[i] is p for p in still):
                    reasons[i] = f"found with {name}"
    return reasons


def classify(path, verdict, carries_nothing):
    if verdict["exists"] is None:
        return verdict["why"]
    if not verdict["exists"]:
        return "does not exist: " + (
            "reflection outside of its facet"
            if "outside" in verdict["why"]
            else "other surfaces on the way"
            if "crosses" in verdict["why"]
            else verdict["why"]
        )
    if carries_nothing:
        return "exists, carries nothing (below -300 dB)"
    edge = verdict["edge_mm"]
    return "exists, " + (
        "within 0.5 mm of an edge"
        if edge < 0.5
        else "within 5 mm of an edge"
        if edge < 5
        else "clear of edges"
    )


def table_of(counter):
    return [f"    {count:5d}  {what}" for what, count in sorted(counter.items())]


def sets(case, referee, sionna, options, ours, theirs, receivers, result):
    """Reports which tool has which paths, and which tool is right about them."""
    pairs, missing, extra, doubled = pair(ours, theirs)
    report(f"  greatx {len(ours)}, Sionna RT {len(theirs)}; pairs {len(pairs)}")
    reasons = (
        {} if options.no_search or not missing else why_missing(sionna, case, receivers, missing, options)
    )
    counts = {
        "only greatx": collections.Counter(),
        "only Sionna RT": collections.Counter(),
        "doubled": collections.Counter(),
    }
    examples = []
    for i, path in enumerate(missing):
        verdict = referee.judge(path)
        what = classify(path, verdict, path.gain_db < -300)
        if verdict["exists"] is not False:
            what += "; " + reasons.get(i, "not looked for" if options.no_search else "never found")
        counts["only greatx"][what] += 1
        examples.append(("only greatx", path, what, verdict))
    for path in extra:
        verdict = referee.judge(path)
        what = classify(path, verdict, path.gain_db < -300)
        counts["only Sionna RT"][what] += 1
        examples.append(("only Sionna RT", path, what, verdict))
    for path, _ in doubled:
        counts["doubled"]["by Sionna RT"] += 1
        examples.append(("doubled", path, "", {}))
    for title, counter in counts.items():
        report(f"  {title}: {sum(counter.values())}")
        for line in table_of(counter):
            report(line)
    for title, path, what, verdict in examples[:12]:
        report(
            f"      e.g. {title}: rx{path.receiver} {path.kinds or 'LoS'} "
            f"{path.length:.4f} m {path.gain_db:.1f} dB {what} "
            f"{verdict.get('why', '')} {'edge %.3f mm' % verdict['edge_mm'] if 'edge_mm' in verdict else ''}"
        )
    result |= {
        "greatx": len(ours),
        "sionna": len(theirs),
        "pairs": len(pairs),
        "doubled": len(doubled),
        "only_greatx": dict(counts["only greatx"]),
        "only_sionna": dict(counts["only Sionna RT"]),
    }
    return pairs


def fields(case, referee, pairs, result):
    """Compares delays, angles and transfer matrices of the pairs. Where transfers differ, it tests whether
    the phase of a slab is the cause, and with which tool the peer checks' own model of slabs agrees."""
    if not pairs:
        return
    d = differences(pairs)
    strong = np.array([p.gain_db > -250 for p, _ in pairs])
    lines = [
        ("delay, mm of path", 1e3 * 299792458.0 * d[:, 0]),
        ("departure, rad", d[:, 1]),
        ("arrival, rad", d[:, 2]),
        ("points, mm", 1e3 * d[:, 4]),
    ]
    report("  pairs differ by                       median      worst")
    for name, values in lines:
        report(f"    {name:32s} {np.median(values):10.2e} {values.max():10.2e}")
    groups = collections.defaultdict(list)
    for i, (ours, theirs) in enumerate(pairs):
        if not strong[i]:
            groups["below -250 dB"].append((d[i, 3], np.nan, np.nan, np.nan))
            continue
        verdict = referee.judge(ours)
        kind = (
            "line of sight"
            if not ours.kinds
            else "with walls passed"
            if "T" in ours.kinds
            else "with an edge"
            if "D" in ours.kinds
            else "reflections"
        )
        own = corrected = np.nan
        if verdict["exists"]:
            field = referee.field(ours, verdict, case)
            size = np.linalg.norm(field)
            own = np.linalg.norm(ours.transfer - field) / size
            turn = np.exp(1j * referee.slab_phase(ours, verdict, case))
            corrected = np.linalg.norm(theirs.transfer * turn - field) / size
            groups[kind].append((d[i, 3], own, np.linalg.norm(theirs.transfer - field) / size, corrected))
        else:
            groups[kind].append((d[i, 3], own, np.nan, corrected))
    report(
        "  transfer, relative (median / worst)     between the two     "
        "greatx - model    Sionna - model    Sionna, slab's phase put right"
    )
    result["transfer"] = {}
    for kind, rows in sorted(groups.items()):
        rows = np.array(rows)
        text = " ".join(
            f"{np.nanmedian(c):8.1e} / {np.nanmax(c):7.1e}" if np.isfinite(c).any() else "        -         "
            for c in rows.T
        )
        report(f"    {kind:22s} {len(rows):5d}        {text}")
        result["transfer"][kind] = {
            "count": len(rows),
            "worst": [float(np.nanmax(c)) if np.isfinite(c).any() else None for c in rows.T],
        }


def recall(case, greatx, receivers, result):
    """Runs greatx's own exhaustive reference on the imported scene."""
    if case.diffraction or not case.recall:
        return
    answer = greatx.recall(case, receivers)
    result["recall"] = answer
    report(
        "  greatx bench --recall, exhaustive reference: "
        + ", ".join(f"{k} {v}" for k, v in answer[0]["beams"]["all"].items())
    )


def compare(case, options, program):
    report(
        f"\n{case.name}: {case.scene}, transmitter {case.transmitter}, "
        f"{case.count} receivers, depth {case.depth}, "
        f"{case.walls} walls at most{', diffraction' if case.diffraction else ''}, "
        f"{case.carrier_hz / 1e9:g} GHz, "
        f"{options.samples:.0e} rays, one receiver a call"
    )
    xml = scene_file(case, options.work)
    referee = Referee(xml)
    receivers = referee.draw_receivers(case)
    greatx = Greatx(program, options.work / "greatx", xml)
    sionna = Sionna(case, options.work)
    ours = greatx.paths(case, receivers)
    theirs = sionna.each_alone(receivers, samples=options.samples)
    result = {"case": case.name}
    pairs = sets(case, referee, sionna, options, ours, theirs, receivers, result)
    fields(case, referee, pairs, result)
    if case.scene == "simple_wedge" and case.material == "metal":
        sionna_wedge.compare(case, pairs, result, report)
    sionna_cfr.compare(case, greatx, sionna, referee, ours, theirs, receivers, result, report)
    recall(case, greatx, receivers, result)
    if case.arrays:
        sionna_cfr.arrays(case, greatx, sionna, receivers, result, report)
    return result


def main(options):
    if options.list:
        print("\n".join(c.name for c in CASES))
        return 0
    program = sionna_setup.program(options)
    results = [
        compare(case, options, program)
        for case in ([case_called(n) for n in options.case] if options.case else CASES)
    ]
    if options.json:
        options.json.write_text(json.dumps(results, indent=1))
    return 0
