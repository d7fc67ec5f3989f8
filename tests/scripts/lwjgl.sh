#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# lwjgl.sh TREE BINDINGS LIBRARY COMPILER: of Darkroom.java, the structs lie as those of C do, and a host with LWJGL
# (examples/Lwjgl.java) makes the picture that the other hosts of docs/hosts.md make. 77: a JDK of 17 and newer, Maven, or in
# its folder LWJGL and JNA, are not here; nothing is fetched from the net.
set -euo pipefail
tree=$1 bindings=$2 library=$3 compiler=$4
for tool in javac mvn; do
    command -v $tool >/dev/null || { echo "left out: $tool is not here (openjdk-17-jdk-headless, maven)" && exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
dependency() { printf '<dependency><groupId>%s</groupId><artifactId>%s</artifactId><version>%s</version>%s</dependency>\n' "$@"; }
{
    echo '<project xmlns="http://maven.apache.org/POM/4.0.0"><modelVersion>4.0.0</modelVersion>'
    echo '<groupId>host</groupId><artifactId>host</artifactId><version>1</version><dependencies>'
    dependency org.lwjgl lwjgl 3.3.6 ''
    dependency org.lwjgl lwjgl 3.3.6 '<classifier>natives-linux</classifier>'
    dependency org.lwjgl lwjgl-vulkan 3.3.6 ''
    dependency net.java.dev.jna jna 5.18.1 ''
    echo '</dependencies></project>'
} >"$work/pom.xml"
mvn -o -q -B -f "$work/pom.xml" dependency:copy-dependencies -DoutputDirectory="$work/jars" >"$work/log" 2>&1 ||
    { echo "left out: Maven's folder has no LWJGL 3.3.6 or JNA 5.18.1 (mvn dependency:copy-dependencies)" && exit 77; }
mkdir "$work/classes"
classes=$work/jars/\*:$work/classes
javac -Xlint:all -Werror -cp "$classes" -d "$work/classes" "$bindings/Darkroom.java" "$tree/examples/Lwjgl.java" \
    "$tree/tests/bindings/Layout.java"

PYTHONDONTWRITEBYTECODE=1 python3 "$tree/tests/bindings/make_layouts.py" "$tree/programs/bindings" "$bindings/api.json" c >"$work/layout.c"
"$compiler" -I "$tree/include" "$work/layout.c" -o "$work/layout"
"$work/layout" | cut -d' ' -f1,2 | sort >"$work/expected"
java -cp "$classes" Layout | sort >"$work/layout.txt"
[[ $(wc -l <"$work/expected") -gt 250 ]] || { echo "C has $(wc -l <"$work/expected") members only" && exit 1; }
diff "$work/expected" "$work/layout.txt" || { echo "structs of C (<) and of Java (>) differ" && exit 1; }

java -cp "$classes" Lwjgl "$library" >"$work/out"
diff <(printf '%s\n' '170 170 170' '223 223 223' '250 250 250') "$work/out" ||
    { echo "the host (>) makes another picture" && exit 1; }
