#!/bin/sh
# What definitions that no output uses cost. In: the built program (MANSARD, else target/release/mansard). Out: instructions
# of `mansard plan` (map, rules, scene, plan; one thread) with and without them, by valgrind, and the difference.
set -eu
program=${MANSARD:-target/release/mansard}
program=$(realpath "$program")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$program" town --seed 3 --buildings 60 -o "$folder" >/dev/null 2>&1
map=$(ls ./*.osm | head -n 1)
elevation=$(ls ./*.tif | head -n 1)

scene() {
    cat <<TEXT
version 1
scene town {
  seed      11
  map       "$map"
  elevation "$elevation"
  rules "mansard:residential.cga" for building[house | detached | residential | yes | garage]
  rules "mansard:building.cga"    for building
  rules "mansard:street.cga"      for highway
}
change burnt { of building  share 50%  rules "mansard:damage.cga" }
camera top { size 96 x 96  gsd 2m  fov 20deg }
sun noon { elevation 50deg  azimuth 160deg }
effects plain { shadows soft  ambient sky }
quality quick { preset draft }
TEXT
}
unused() {
    cat <<TEXT
sun dusk        { elevation 4deg  azimuth 280deg }
effects crude   { shadows hard  ambient constant(40%) }
quality costly  { preset high  shadow_map 16384 }
camera oblique  { size 4000 x 4000  gsd 0.1m  fov 60deg  off_nadir 40deg }
pass shown_not  { show all with burnt as colour, class, depth, instance, level  shadows hard }
TEXT
}
used() {
    cat <<TEXT
pass before { show all }
pass mask   { show all with burnt mark burnt as mask }
dataset d   { views 1 * top  passes before, mask  sun noon  effects plain  quality quick }
TEXT
}
{ scene; used; } >lean.render
{ scene; unused; used; } >fat.render

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" plan "$1" --quiet --jobs 1 2>&1 >/dev/null |
        sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}
lean=$(instructions lean.render)
fat=$(instructions fat.render)
echo "without: $lean instructions"
echo "with:    $fat instructions"
awk -v lean="$lean" -v fat="$fat" 'BEGIN { printf "more:    %.4f %%\n", 100 * (fat - lean) / lean }'
