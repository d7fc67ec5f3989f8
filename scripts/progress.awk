# SPDX-License-Identifier: MIT
# How far a build is: "PERCENT SECONDS" (left), or nothing before there is something to say.
#   awk -v elapsed=SECONDS -f progress.awk part=last .ninja_log part=plan PLAN part=now LOG
# Steps are unequal, so each counts as many milliseconds as its file took in the folder's last build (.ninja_log), and where
# there was none, as usual() says: with it, the seconds left of a first build, replayed step by step from what each took,
# were right within a fifth from the first tenth on. PLAN is what `ninja -n` says beforehand, LOG what the build says
# meanwhile.
# The seconds are those that went by, times what is left by what is done: a machine at another pace changes nothing, and
# what the cache has makes them too few or too many until it is known how much that is.

function usual(file) {
    if (file !~ /\.(o|gch)$/) return 200
    if (file ~ /^effects\//) return 600
    return file ~ /^(programs|edit\/viewer|proof\/verifier|scenes\/scene)\// ? 6000 : 4000
}

part == "last" && NF >= 5 { took[$4] = $2 - $1 }

part != "last" && /^\[[0-9]+\/[0-9]+\] / {
    step = $0
    sub(/^[^ ]* /, "", step)
}

part == "plan" && step != "" {
    file = step
    sub(/.* /, "", file)
    weight[step] = file in took ? took[file] + 1 : usual(file)
    all += weight[step]
}

part == "now" && step in weight {
    done += weight[step]
    delete weight[step]
}

{ step = "" }

END {
    if (all > 0 && done > 0) printf "%d %d\n", 100 * done / all, elapsed * (all - done) / done + 0.5
}
