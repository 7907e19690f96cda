#!/usr/bin/env python3
"""From a save to new pixels. In: the built program (MANSARD, else target/release/mansard), the folder of the real data
(DATA). Out: a table of milliseconds per phase of `mansard watch --headless` on the Piedmont window, median of REPEATS saves
of each kind, and the lines of JSON in OUT if that is given."""

import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[3]
program = os.path.abspath(os.environ.get("MANSARD", root / "target/release/mansard"))
data = pathlib.Path(os.environ.get("DATA", root / "../shared/data")).resolve()
repeats = int(os.environ.get("REPEATS", "5"))
side = os.environ.get("SIDE", "512px")

shop = pathlib.Path(tempfile.mkdtemp())
for rules in (root / "rules").glob("*.cga"):
    shutil.copy(rules, shop)
recipe = (root / "examples/syncw/syncw.render").read_text().replace('"mansard:', '"')
# Fifty lots of their own.
recipe = recipe.replace("change burnt {", 'change few { of building  count 50  rules "few.cga" }\n\nchange burnt {')
recipe = recipe.replace("pass after  { show all  with burnt ", "pass after  { show all  with few, burnt ")
(shop / "place.render").write_text(recipe)
shutil.copy(root / "rules/residential.cga", shop / "few.cga")

maps = ",".join(str(data / "osm" / f"piedmont-ca-{what}.overpass.json.gz") for what in ("buildings", "roads"))
arguments = [
    program, "watch", "place.render", "--headless", "--png", "now.png",
    "--set", f"map={maps}", "--set", f"elevation={data}/dem/piedmont-oakland-ca-dem-30m.tif",
    "--set", "window=-122.2473,37.8143,-122.2245,37.8323", "--set", f"side={side}",
]
watch = subprocess.Popen(arguments, cwd=shop, stdout=subprocess.PIPE, text=True)
log = open(os.environ["OUT"], "w") if "OUT" in os.environ else None


def line():
    text = watch.stdout.readline()
    if not text:
        sys.exit("the program ended")
    if log:
        log.write(text)
        log.flush()
    return json.loads(text)


def after_save(is_change):
    """A save may be told in two bursts, of which the second changes nothing."""
    update = line()
    while is_change and not update["changed"]:
        update = line()
    return update


def save(name, change):
    path = shop / name
    path.write_text(change(path.read_text()))


def edited(name, old, new):
    """Saves old -> new and back in turns; the updates."""
    updates = []
    for _ in range(repeats):
        time.sleep(0.3)
        save(name, lambda text: text.replace(old, new, 1))
        updates.append(after_save(old != new))
        old, new = new, old
    return updates


cold = line()
kinds = [
    ("cold", [cold]),
    ("a rule of all houses (walls)", edited("residential.cga", "color(wallColor)", 'color("#b0a090")')),
    ("a rule of 50 lots", edited("few.cga", "t(0, minHeight, 0)", "t(0, minHeight, 0) set(material.roughness, 0.5)")),
    ("a comment", edited("residential.cga", "/* Roofs over wide", "/*  Roofs over wide")),
    ("nothing", edited("residential.cga", "Roofs", "Roofs")),
    ("the sun", edited("place.render", "declination uniform(30deg, 140deg)", "declination uniform(31deg, 140deg)")),
]
watch.terminate()
names = ["look", "compile", "place", "prepare", "derive", "ground", "assemble", "views"]
drawn = ["plan", "upload", "draw", "encode"]
print("| saved | derived | kept | " + " | ".join(names) + " | without pixels | " + " | ".join(drawn) + " |")
print("|" + " --- |" * (len(names) + len(drawn) + 4))
for name, updates in kinds:
    def of(update, phase, where="phases"):
        phases = update[where] if where == "phases" else (update["picture"] or {"phases": []})["phases"]
        return sum(p["ms"] for p in phases if p["name"] == phase)

    def median(measure):
        return f"{statistics.median(measure(update) for update in updates):.1f}"

    cells = [median(lambda u, n=n: of(u, n)) for n in names]
    total = median(lambda u: sum(p["ms"] for p in u["phases"]))
    pixels = [median(lambda u, n=n: of(u, n, "picture")) for n in drawn]
    done = updates[0]["redone"]
    print(f"| {name} | {done['lots_derived']} | {done['lots_kept']} | " + " | ".join(cells + [total] + pixels) + " |")
shutil.rmtree(shop)
