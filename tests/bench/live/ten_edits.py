#!/usr/bin/env python3
"""A log of `mansard watch --headless` through ten edits of examples/riverside. In: the built program (MANSARD, else
target/release/mansard). Out: docs/watch-log.md's text on standard output: each edit and the line of JSON that follows."""

import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[3]
program = os.path.abspath(os.environ.get("MANSARD", root / "target/release/mansard"))
shop = pathlib.Path(tempfile.mkdtemp())
for file in list((root / "rules").glob("*.cga")) + list((root / "examples/riverside").iterdir()):
    shutil.copy(file, shop)
recipe = shop / "riverside.render"
recipe.write_text(recipe.read_text().replace('"mansard:', '"'))

watch = subprocess.Popen(
    [program, "watch", "riverside.render", "--headless", "--png", "now.png"], cwd=shop, stdout=subprocess.PIPE, text=True
)


def told():
    text = watch.stdout.readline()
    if not text:
        sys.exit("the program ended")
    return json.loads(text)


def after_save(changes):
    """A save may be told in two bursts, of which the second changes nothing."""
    update = told()
    while changes and not update["changed"]:
        update = told()
    return update


def save(name, old, new):
    path = shop / name
    text = path.read_text()
    assert old in text, (name, old)
    path.write_text(text.replace(old, new, 1))


def put(title, update):
    redone = {what: value for what, value in update["redone"].items() if value}
    phases = " ".join(f"{phase['name']} {phase['ms']:.1f}" for phase in update["phases"] if phase["ms"] >= 0.05)
    total = sum(phase["ms"] for phase in update["phases"])
    print(f"\n# {title}")
    print(f"update {update['number']}: {json.dumps(redone)}" + (", the last good scene stands" if update["stands"] else ""))
    print(f"  {total:.1f} ms: {phases or 'nothing to do'}")
    if update["picture"]:
        pixels = [phase for phase in update["picture"]["phases"] if not phase["name"].startswith("pass")]
        print("  pixels: " + " ".join(f"{phase['name']} {phase['ms']:.1f}" for phase in pixels))
    print(f"  {update['triangles']} triangles, geometry {(update['geometry_sha256'] or 'none')[:12]}")
    for diagnostic in update["diagnostics"]:
        place = f"{diagnostic.get('file')}:{diagnostic.get('line')}:{diagnostic.get('column')}"
        print(f"  {diagnostic['severity']} {diagnostic['code']} {place} {diagnostic['message']}")


print("# Ten edits of Riverside\n")
print("Recorded by `tests/bench/live/ten_edits.py`: 400 buildings, 1024 × 1024 pixels, lines of JSON shortened.")
print(f"Machine: {os.cpu_count()} cores ({platform.machine()}), Mesa's llvmpipe as the adapter; milliseconds.\n\n```")
print("$ mansard watch riverside.render --headless --png now.png")
put("start", told())
edits = [
    ("1. residential.cga: another colour of plaster", "residential.cga", "color(wallColor)\n    setupProjection(0, scope.xy, 4", "color(\"#b0a090\")\n    setupProjection(0, scope.xy, 4"),
    ("2. residential.cga: a comment", "residential.cga", "/* Roofs over", "/*  Roofs over"),
    ("3. residential.cga: a mistake", "residential.cga", "FlatRoof -->", "FlatRoof ->"),
    ("4. residential.cga: mended", "residential.cga", "FlatRoof ->", "FlatRoof -->"),
    ("5. riverside.render: another sun", "riverside.render", "tilt 40deg", "tilt 30deg"),
    ("6. damage.cga: another colour", "damage.cga", "#8d857d", "#705040"),
    ("7. street.cga: saved as it was", "street.cga", "-->", "-->"),
    ("8. riverside.render: another seed", "riverside.render", "seed       1", "seed       2"),
]
for title, name, old, new in edits:
    time.sleep(0.3)
    save(name, old, new)
    put(title, after_save(old != new))
time.sleep(0.3)
text = (shop / "building.cga").read_text()
(shop / "building.cga").unlink()
put("9. building.cga deleted", after_save(True))
time.sleep(0.3)
(shop / "building.cga").write_text(text)
put("10. building.cga made again", after_save(True))
print("```")
watch.terminate()
shutil.rmtree(shop)
