# SPDX-License-Identifier: MIT
# build/generated/house.txt (cmake/DarkroomHouse.cmake) as a graph for dot: a box for each target, with its folders and
# rooms. Colours hold on a light page and on a dark one.

function short(path) { sub(/^.*\//, "", path); return path }

# What is drawn of a target's kind: colour of the box, and the word for it.
function fill(name) {
    if (name == "darkroom_tests" || name == "darkroom_bench" || name == "darkroom_compilers" || name ~ /^(make|example)_/)
        return "#ece4f4"
    return kind[name] == "executable" ? "#fbe3c4" : kind[name] == "shared" ? "#d3edd3" : kind[name] == "module" ? "#f6eebb" : "#d6e4f7"
}
function title(name) {
    if (kind[name] == "shared") {
        sub(/_shared$/, "", name)
        return "lib" name ".so"
    }
    return folder[name]
}
function subtitle(name) {
    if (kind[name] == "shared") return name
    return kind[name] == "module" ? "lib" name ".so" : name
}

$1 == "target" { kind[$2] = $3; folder[$2] = $4; names[++count] = $2 }
$1 == "room" {
    room = short($3)
    if (room == "*") room = "one folder an effect"
    # Lines of some words, so that boxes are as wide as they are high.
    if (length(line[$2] room) > 28) { rooms[$2] = rooms[$2] "<BR/>"; line[$2] = "" }
    else if (line[$2] != "") { rooms[$2] = rooms[$2] " &#183; "; line[$2] = line[$2] "   " }
    rooms[$2] = rooms[$2] room
    line[$2] = line[$2] room
}
$1 == "links" { edges[++edge_count] = sprintf("\"%s\" -> \"%s\"", $2, $3) }
$1 == "starts" { edges[++edge_count] = sprintf("\"%s\" -> \"%s\" [style=dashed]", $2, $3) }

END {
    print "digraph house {"
    print "  graph [bgcolor=transparent, ranksep=0.42, nodesep=0.14, margin=0]"
    print "  node [shape=box, style=\"filled,rounded\", color=\"#6b7787\", penwidth=1, margin=\"0.09,0.05\", fontname=\"sans-serif\", fontcolor=\"#1b222b\"]"
    print "  edge [color=\"#7d8a9b\", penwidth=1.3, arrowsize=0.7]"
    for (i = 1; i <= count; ++i) {
        name = names[i]
        label = "<B>" title(name) "</B><BR/><FONT POINT-SIZE=\"11\" COLOR=\"#4a5665\">" subtitle(name) "</FONT>"
        if (name in rooms) label = label "<BR/><FONT POINT-SIZE=\"11\">" rooms[name] "</FONT>"
        printf "  \"%s\" [label=<%s>, fillcolor=\"%s\"]\n", name, label, fill(name)
    }
    for (i = 1; i <= edge_count; ++i) print "  " edges[i]
    print "}"
}
