#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# on_release.sh TREE: what scripts/on_release hands to a command and hands on of it, what it keeps and what goes, with a
# debootstrap that makes a system of this machine's shell and a few programs. Ends with 77, which CTest takes for skipped,
# where namespaces and mounts are not allowed.
set -euo pipefail
unset DARKROOM_TEST_DATA XDG_CACHE_HOME
skip() { echo "on_release: skipped, $*" && exit 77; }
[[ $(id -u) == 0 ]] || skip "not root"
command -v git >/dev/null || skip "no git"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unshare --mount --pid --fork bash -c "mount -t tmpfs tmpfs '$work' && mount -t devpts -o newinstance devpts '$work'" \
    2>/dev/null || skip "mounts are not allowed here"
fail() {
    printf 'on_release: %s\n' "$*" >&2
    [[ ! -s $work/said ]] || cat "$work/said" >&2
    exit 1
}

mkdir -p "$work/bin" "$work/debootstrap/scripts" "$work/data" "$work/tree/scripts"
touch "$work/debootstrap/scripts/old" "$work/data/of_tests"
cat >"$work/bin/debootstrap" <<'STUB'
#!/usr/bin/env bash
echo made >>"$STUB_LOG"
[[ -z ${STUB_FAILS:-} ]] || { echo "E: no such mirror" && exit 1; }
base=$3
mkdir -p "$base"/{dev/pts,dev/shm,etc/apt/apt.conf.d,mnt,proc,root,tmp,var/cache/apt/archives}
ln -s /proc/self/fd "$base/dev/fd"
touch "$base/dev/ptmx"
mknod -m 666 "$base/dev/null" c 1 3
echo "deb http://debian.example $2 main" >"$base/etc/apt/sources.list"
for program in bash cat env ls script sleep tty; do
    path=$(command -v "$program")
    for file in "$path" $(ldd "$path" | grep -oE '/[^ ]+'); do
        mkdir -p "$base$(dirname "$file")"
        cp -L "$file" "$base$file"
    done
done
mkdir -p "$base/bin" "$base/usr/bin"
cp -n "$base/usr/bin/"* "$base/bin/" 2>/dev/null || cp -n "$base/bin/"* "$base/usr/bin/"
ln -sf bash "$base/bin/sh"
STUB
chmod +x "$work/bin/debootstrap"
export PATH="$work/bin:$PATH" STUB_LOG=$work/made DEBOOTSTRAP_DIR=$work/debootstrap DARKROOM_RELEASES=$work/releases
: >"$STUB_LOG"
cp -L "$1/scripts/on_release" "$work/tree/scripts/"
cd "$work/tree"
git init -q
echo one >committed
git add . && git -c user.name=test -c user.email=test@example.com commit -qm one
echo two >only_here

# on EXIT ARGUMENT...: runs it, and expects this end.
on() {
    local wanted=$1 status=0
    shift
    scripts/on_release "$@" >"$work/out" 2>"$work/said" || status=$?
    [[ $status == "$wanted" ]] || fail "$*: ends with $status, not $wanted"
}
clean() {
    ! grep -q "$work" /proc/mounts || fail "$1: mounts are left"
    [[ $(ls "$work/releases/old") == $'base\ndebootstrap.log\npackages'"${2:-}" ]] || fail "$1: $(ls "$work/releases/old")"
}

# What cannot be is said in a line.
on 2 old && grep -q '^on_release: .*RELEASE COMMAND' "$work/said" || fail "no command"
on 2 never ls && grep -q '^on_release: never: no release that debootstrap knows' "$work/said" || fail "an unknown release"
on 2 ../old ls && grep -q '^on_release: [.][.]/old: no release' "$work/said" || fail "a path for a release"
STUB_FAILS=1 on 2 old ls && grep -q 'no such mirror' "$work/said" || fail "the end of debootstrap's log"
[[ ! -e $work/releases/old/base ]] || fail "half a release is kept"

# A command has a clone of what is committed, a login's environment and a terminal where it opens one; its output and its
# end are handed on, in one line each of arguments as they were.
: >"$STUB_LOG"
FOREIGN=1 on 7 old bash -c 'cat committed; [[ ! -e only_here ]] && echo "$PWD $HOME ${FOREIGN-none} <$1>"; echo wrong >&2
    echo kept >/var/cache/apt/archives/a.deb; echo more >/root/more; script -qec tty /dev/null </dev/null; exit 7' bash 'a  b'
[[ $(tr -d '\r' <"$work/out") == $'one\n/root/darkroom /root none <a  b>\n/dev/pts/0' ]] || fail "output: $(<"$work/out")"
grep -qx wrong "$work/said" || fail "standard error"
clean "a command that failed"

# The next finds what was downloaded, and nothing else; the release is not made again, until it is a month old.
on 0 old bash -c '[[ -e /var/cache/apt/archives/a.deb && ! -e /root/more ]]'
[[ $(wc -l <"$STUB_LOG") == 1 ]] || fail "the release is made for each run"
touch -d '40 days ago' "$work/releases/old/base"
on 0 old ls && [[ $(wc -l <"$STUB_LOG") == 2 ]] || fail "the release stays as it was for ever"
grep -q 'not committed' "$work/said" && fail "a file that git does not know is no change"
echo three >committed
DARKROOM_TEST_DATA=$work/data on 0 old bash -c 'cat committed "$DARKROOM_TEST_DATA/of_tests" && ! echo x >"$DARKROOM_TEST_DATA/new"'
[[ $(<"$work/out") == one && ! -e $work/data/new ]] && grep -q 'not committed' "$work/said" || fail "the clone, or the test data"

# --keep goes on in what the last one left, with what was committed since.
on 0 --keep old bash -c 'echo more >/root/more'
git -c user.name=test -c user.email=test@example.com commit -qam three
on 0 --keep old bash -c 'cat committed /root/more' && [[ $(<"$work/out") == $'three\nmore' ]] || fail "--keep: $(<"$work/out")"
clean "--keep" $'\nrun'

# It goes with its processes where it is ended.
scripts/on_release old sleep "1000.$$" 2>"$work/said" &
for _ in {1..100}; do pgrep -fx "sleep 1000[.]$$" >/dev/null && break || sleep 0.1; done
pgrep -fx "sleep 1000[.]$$" >/dev/null || fail "a command that does not start"
kill $!
wait $! || true
for _ in {1..100}; do pgrep -fx "sleep 1000[.]$$" >/dev/null && sleep 0.1 || break; done
! pgrep -fx "sleep 1000[.]$$" >/dev/null || fail "a command outlives what ran it"
clean "a command that was ended"
echo "on_release: all as it should be"
