#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# bindings.sh LANGUAGE TREE BINDINGS PROGRAM LIBRARY COMPILER: a host in LANGUAGE (python, rust, csharp) is compiled and
# run. Its structs lie as those of C do, and it prints what the program and the header say. The page's example runs,
# too. 77: the language is not here.
set -euo pipefail
language=$1 tree=$2 bindings=$3 program=$4 library=$5 compiler=$6
case $language in
    python) needed=(python3) packages=python3 ;;
    rust) needed=(rustc) packages=rustc ;;
    csharp) needed=(mcs mono) packages='mono-mcs and mono-runtime' ;;
    *) echo "bindings.sh: no language $language" && exit 1 ;;
esac
for tool in "${needed[@]}"; do
    command -v "$tool" >/dev/null || { echo "left out: $tool is not here (Debian's $packages)" && exit 77; }
done
if [[ $language == rust ]]; then
    minor=$(rustc --version | sed -E 's/^rustc 1\.([0-9]+).*/\1/')
    [[ $minor -ge 85 ]] || { echo "left out: $(rustc --version) is older than 1.85, edition 2024" && exit 77; }
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1 LD_LIBRARY_PATH=${library%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
layouts() { python3 "$tree/tests/bindings/make_layouts.py" "$tree/programs/bindings" "$bindings/api.json" "$1"; }

# The first example of the language.
sed -n "/^\`\`\`$language\$/,/^\`\`\`\$/{/^\`\`\`/d;p}" "$tree/docs/bindings.md" >"$work/example"
[[ -s $work/example ]] || { echo "docs/bindings.md has no example in $language" && exit 1; }
case $language in
    python)
        cp "$work/example" "$work/example.py"
        example=(env PYTHONPATH="$bindings" python3 "$work/example.py")
        host=(python3 "$tree/tests/bindings/host.py" "$bindings" "$library")
        ;;
    rust)
        cp "$tree/tests/bindings/host.rs" "$bindings/darkroom.rs" "$work"
        layouts rust >"$work/layout.rs"
        { cat "$work/example" && echo 'fn main() { stack().unwrap(); }'; } >"$work/example.rs"
        # `cargo new` writes the newest edition, and older projects stay at theirs.
        for edition in 2021 2024; do
            rustc --edition $edition -D warnings -L "${library%/*}" "$work/host.rs" -o "$work/host"
            rustc --edition $edition -D warnings -L "${library%/*}" -C link-arg=-Wl,-rpath,"${library%/*}" \
                "$work/example.rs" -o "$work/example.out"
        done
        # It finds the library by itself, as the page says.
        env -u LD_LIBRARY_PATH "$work/example.out"
        host=("$work/host")
        example=("$work/example.out")
        ;;
    csharp)
        layouts csharp >"$work/Layout.cs"
        mcs -unsafe -warnaserror -out:"$work/host.exe" "$tree/tests/bindings/Host.cs" "$bindings/Darkroom.cs" \
            "$work/Layout.cs"
        host=(mono "$work/host.exe")
        cp "$work/example" "$work/Example.cs"
        mcs -unsafe -warnaserror -out:"$work/example.exe" "$work/Example.cs" "$bindings/Darkroom.cs"
        example=(mono "$work/example.exe")
        ;;
esac

layouts c >"$work/layout.c"
"$compiler" -I "$tree/include" "$work/layout.c" -o "$work/layout"
"$work/layout" | sort >"$work/expected"
"${host[@]}" layout | sort >"$work/layout.txt"
[[ $(wc -l <"$work/expected") -gt 250 ]] || { echo "C has $(wc -l <"$work/expected") members only" && exit 1; }
diff "$work/expected" "$work/layout.txt" || { echo "structs of C (<) and of $language (>) differ" && exit 1; }

"${host[@]}" >"$work/out" || { cat "$work/out" && exit 1; }
"$program" effects | sed -E 's/ .*//; s/^/effect /' >"$work/effects"
grep '^effect ' "$work/out" | diff "$work/effects" - ||
    { echo "the program (<) and $language (>) have other effects" && exit 1; }
while IFS= read -r line; do
    grep -qxF -- "$line" "$work/out" || { echo "there is no line '$line' in:" && cat "$work/out" && exit 1; }
done <<'END'
     fused: bloom exposure tonemap encode
look vignette None
warning warned.toml:3:1: unknown key 'bloom_intensitty' = 1, did you mean 'bloom_intensity', which takes [0, 16]?
error 1 darkroom_composer_set_number: bloom.intensity = -1: allowed is [0, 16]
error 1 darkroom_look_parse: wrong.toml:2:12: exposure = "é": 'é' is not a number, allowed is [0, 1024] x, also in ev, stop or stops
error 1 darkroom_device_assumed: profile = 7: allowed is 0 to 1
END
"${example[@]}" >"$work/out" || { echo "the example of docs/bindings.md fails:" && cat "$work/out" && exit 1; }
