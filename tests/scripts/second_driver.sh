#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# second_driver.sh COMMAND...: runs a command on the second Vulkan driver, SwiftShader, having named it and its version on
# standard error. The environment may name another driver's file (*_icd.json) in DARKROOM_SECOND_DRIVER. Ends with 77, which
# CTest takes for skipped, where there is none.
set -euo pipefail
driver=${DARKROOM_SECOND_DRIVER:-}
from="DARKROOM_SECOND_DRIVER"
if [[ -z $driver ]]; then
    # Debian's chromium-common; others have it in the folder of the browser itself.
    driver=$(dpkg-query -L chromium-common 2>/dev/null | grep -m1 '/vk_swiftshader_icd\.json$') || true
    from=$(dpkg-query -W -f='${Package} ${Version}' chromium-common 2>/dev/null) || from="an unknown version"
    for folder in /usr/lib/chromium /usr/lib64/chromium-browser /usr/lib/chromium-browser; do
        [[ -n $driver || ! -f $folder/vk_swiftshader_icd.json ]] || driver=$folder/vk_swiftshader_icd.json
    done
    if [[ -z $driver ]]; then
        echo "second driver: skipped, there is none: it is in Debian's package chromium-common"
        exit 77
    fi
fi
[[ -r $driver ]] || { echo "second driver: $driver cannot be read" >&2 && exit 2; }
echo "second driver: $driver of $from" >&2
# Loaders older than 1.3.207 know the second name alone.
exec env VK_DRIVER_FILES="$driver" VK_ICD_FILENAMES="$driver" "$@"
