# SPDX-License-Identifier: MIT
# What ./darkroom and ./test share: installing missing packages, configuring, building. Sourced, with `root` set to the
# folder of the tree and `yes` to 1 where packages are installed without asking. All it says goes to standard error, and
# what the compiler says to FOLDER/build.log.

say() { printf 'darkroom: %s\n' "$*" >&2; }
die() {
    say "$*"
    exit 2
}

# What packages.txt names, and what the caller has in `extra_packages`.
extra_packages=()
wanted_packages() {
    sed 's/#.*//' "$root/packages.txt" | awk 'NF { print $1 }'
    [[ ${#extra_packages[@]} == 0 ]] || printf '%s\n' "${extra_packages[@]}"
}

missing_packages() {
    local -A installed=()
    local name status
    while read -r name status; do
        [[ $status == installed ]] && installed[$name]=1
    done < <(wanted_packages | xargs dpkg-query -W -f='${Package} ${db:Status-Status}\n' 2>/dev/null)
    for name in $(wanted_packages); do
        [[ -n ${installed[$name]:-} ]] || printf '%s\n' "$name"
    done
}

# Ends where a package is older than packages.txt asks for: the one that is installed, or else the one that would be, of
# which apt knows nothing where it has no lists yet.
refuse_old_packages() {
    local name needed version old=
    local -A found=()
    while read -r name version; do found[$name]=$version; done < <(wanted_packages |
        LC_ALL=C xargs apt-cache policy 2>/dev/null | awk '/^[^ ]/ { name = $1; sub(/:$/, "", name) }
            $1 == "Installed:" { installed = $2 }
            $1 == "Candidate:" { version = installed == "(none)" ? $2 : installed; if (version != "(none)") print name, version }')
    while read -r name needed; do
        version=${found[$name]:-}
        [[ -z $version ]] || dpkg --compare-versions "$version" ge "$needed" ||
            old+="${old:+, }$name $version ($needed is needed)"
    done < <(sed 's/#.*//' "$root/packages.txt" | awk 'NF == 2')
    [[ -z $old ]] || die "too old here: $old"
}

# Tells how far apt is, of whose state these are the lines: every 20 percent.
tell_apt() {
    local kind percent said=
    while IFS=: read -r kind _ percent _; do
        case $kind in
            dlstatus) kind=downloading ;;
            pmstatus) kind=unpacking ;;
            *) continue ;;
        esac
        percent=$((${percent%%.*} / 20 * 20))
        [[ $kind$percent == "$said" ]] || say "packages: $kind, $percent %"
        said=$kind$percent
    done
}

# Installs what is missing, but not unasked. Root without a terminal, as in containers, is not asked, since nobody is there
# to answer; another user without one gets the command to run.
install_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "no apt-get here; if the build fails, these packages (names of Debian) are needed:" $(wanted_packages)
        return
    fi
    local missing as_root=()
    refuse_old_packages
    missing=$(missing_packages | xargs)
    [[ -n $missing ]] || return 0
    [[ $(id -u) == 0 ]] || as_root=(sudo)
    local install="${as_root[*]} apt-get install -y --no-install-recommends $missing"
    install=${install# }
    say "missing packages: $missing"
    if [[ $yes != 1 ]]; then
        if [[ -t 0 && -t 2 ]]; then
            local answer
            read -r -p "darkroom: install them${as_root:+ by sudo}? [Y/n] " answer || answer=n
            [[ -z $answer || ${answer,,} =~ ^y(es)?$ ]] || die "nothing was installed; they are by: $install"
        elif [[ -n ${as_root:-} ]]; then
            die "nothing was installed (--yes or DARKROOM_YES=1 installs them); they are by: $install"
        fi
    fi
    if [[ -n ${as_root:-} ]] && ! command -v sudo >/dev/null; then
        # The libraries may have come another way, and if not, what CMake says names the first one.
        say "neither root nor sudo: building without them"
        return
    fi
    say "installing them"
    local as=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive) quiet=(-qq -o Dpkg::Use-Pty=0)
    "${as[@]}" apt-get "${quiet[@]}" update >>"$log" 2>&1 ||
        say "apt-get update failed; going on with the package lists that are there"
    refuse_old_packages
    # How far apt is, it tells in a descriptor of its own, since packages print; sudo would close one that is opened here.
    # Word by word: $missing is a list.
    "${as[@]}" sh -c 'exec apt-get "$@" 3>&1 >&2' apt-get "${quiet[@]}" -o APT::Status-Fd=3 install -y \
        --no-install-recommends $missing 2>>"$log" | tell_apt || failed "installing packages"
}

# What the caller has in DARKROOM_OPTIONAL_PACKAGES, as far as root can have it: what needs one of them is skipped without.
install_optional_packages() {
    local name apt=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
    for name in ${DARKROOM_OPTIONAL_PACKAGES:-}; do
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) != installed ]] || continue
        say "installing $name"
        { [[ $(id -u) == 0 ]] && "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "$name"; } \
            >>"$log" 2>&1 || say "$name could not be installed: going on without it"
    done
}

failed() {
    [[ -t 2 ]] && printf '\r\033[K' >&2
    tail -n 40 "$log" >&2
    die "$1 failed; the lines above are the end of $log"
}

# How far the build in folder $1 is, for as long as process $2 lives: on a terminal one line that renews itself, and
# elsewhere a line every ten percent.
show_progress() {
    local folder=$1 builder=$2 started=$SECONDS said=0 now percent seconds
    while kill -0 "$builder" 2>/dev/null; do
        now=$(awk -v elapsed=$((SECONDS - started)) -f "$root/scripts/progress.awk" part=last "$folder/.last_log" \
            part=plan "$folder/.plan" part=now "$log") || true
        read -r percent seconds <<<"$now" || true
        if [[ -n $percent && -t 2 ]]; then
            printf '\r\033[Kdarkroom: building: %d %%, about %d s left' "$percent" "$seconds" >&2
        elif [[ -n $percent && $((percent / 10)) -gt $said ]]; then
            said=$((percent / 10))
            say "building: $percent %, about $seconds s left"
        fi
        sleep 0.2
    done
    [[ ! -t 2 ]] || printf '\r\033[K' >&2
}

# What the program is made of. A folder counts as well as the files in it: one that came or went changed it.
program_sources=(CMakeLists.txt CMakePresets.json packages.txt cmake include engine files run scenes edit
    proof programs effects samples looks)

# Was target $2 built in folder $1 from what the tree holds now? It costs one walk over the sources and starts no CMake.
# The stamp is as old as the start of that build, so a file saved while it ran is newer. Pictures in samples/, and models
# and pictures in scenes/, are made by the build itself.
is_current() {
    local stamp=$1/.built-$2
    [[ ! $1/.built-all -nt $stamp ]] || stamp=$1/.built-all
    [[ -x $1/bin/darkroom && -f $stamp && $(<"$stamp") == "$root" ]] || return 1
    compgen -G "$root/samples/*.exr" >/dev/null && compgen -G "$root/scenes/models/*.glb" >/dev/null || return 1
    local made=('(' -path "$root/samples" -o -path "$root/scenes" -o -path "$root/scenes/models" -o -name '*.exr' -o
        -name '*.glb' -o -name '*.hdr' -o -name '*.png' ')')
    [[ -z $(find "${program_sources[@]/#/$root/}" ! "${made[@]}" -newer "$stamp" -print -quit) ]]
}

# How much of the last build came from the compiler's cache, of which nothing is said where it compiled nothing.
say_cache_hits() {
    [[ -s $1 ]] || return 0
    local hits misses
    hits=$(grep -cE '^(direct|preprocessed)_cache_hit$' "$1") || true
    misses=$(grep -cx cache_miss "$1") || true
    say "$hits of $((hits + misses)) compiled files from the cache"
}

# build FOLDER TARGETS CMAKE_OPTION...: configures and builds TARGETS, which are parted by blanks. One build at a time in a
# folder. The environment has further options in DARKROOM_CMAKE_OPTIONS, parted by blanks, too.
build() {
    local folder=$1 targets target
    read -ra targets <<<"$2"
    shift 2
    mkdir -p "$folder" 2>/dev/null && [[ -w $folder ]] ||
        die "$folder cannot be written: name a folder for the build in DARKROOM_BUILD"
    log=$folder/build.log
    if command -v flock >/dev/null; then
        exec 9>"$folder/.lock"
        flock -n 9 || { say "waiting for another build in $folder" && flock 9; }
    fi
    : >"$log"
    install_packages
    install_optional_packages
    command -v cmake >/dev/null || die "cmake not found; needed packages (names of Debian): $(wanted_packages | xargs)"

    # A folder that was configured for a tree elsewhere (moved, copied) starts anew.
    if [[ -f $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
        rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles" "$folder"/.built-*
    fi
    if [[ ! -x $folder/bin/darkroom ]]; then
        say "building in $folder, some minutes the first time"
    elif [[ ! -f $folder/.built-${targets[-1]} && ! -f $folder/.built-all ]]; then
        say "building ${targets[-1]}, a part that is built when it is first asked for"
    fi
    printf '%s' "$root" >"$folder/.building"
    cmake -S "$root" -B "$folder" "$@" ${DARKROOM_CMAKE_OPTIONS:-} >>"$log" 2>&1 || failed "configuring"
    # What progress is measured by; ninja writes its log anew as it builds. Of build.ninja itself a dry run plans no more
    # than to look for new files, as CMake wants that done first, so it reads a copy.
    cp "$folder/build.ninja" "$folder/.plan.ninja" 2>/dev/null || true
    ninja -C "$folder" -f .plan.ninja -n "${targets[@]}" >"$folder/.plan" 2>/dev/null || true
    cp "$folder/.ninja_log" "$folder/.last_log" 2>/dev/null || : >"$folder/.last_log"
    # Without the lock, which a compiler cache's server would keep.
    rm -f "$folder/.ccache"
    CCACHE_STATSLOG=$(cd "$folder" && pwd)/.ccache cmake --build "$folder" --target "${targets[@]}" >>"$log" 2>&1 9>&- &
    local builder=$!
    trap 'kill "$builder" 2>/dev/null; exit 130' INT TERM
    show_progress "$folder" "$builder"
    wait "$builder" || failed "building"
    trap - INT TERM
    for target in "${targets[@]}"; do cp -p "$folder/.building" "$folder/.built-$target"; done
    say_cache_hits "$folder/.ccache"
    exec 9>&-
}
