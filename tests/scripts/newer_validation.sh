#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# newer_validation.sh [--gpu-assisted] COMMAND...: runs a command under the validation layer that comes with the second
# driver, some years newer than Debian's own, having named its version on standard error. The environment may name another
# folder with libVkLayer_khronos_validation.so in DARKROOM_NEWER_VALIDATION. Its checks of synchronization are on; with
# --gpu-assisted its checks of what kernels read and write out of bounds are, too. Ends with 77, which CTest takes for
# skipped, where there is none.
set -euo pipefail
checks=
[[ ${1:-} != --gpu-assisted ]] || { checks=$1 && shift; }
folder=${DARKROOM_NEWER_VALIDATION:-}
from=DARKROOM_NEWER_VALIDATION
if [[ -z $folder ]]; then
    from=$(dpkg-query -W -f='${Package} ${Version}' chromium-common 2>/dev/null) || from="an unknown version"
    for place in /usr/lib/chromium /usr/lib64/chromium-browser /usr/lib/chromium-browser; do
        [[ -n $folder || ! -f $place/libVkLayer_khronos_validation.so ]] || folder=$place
    done
    if [[ -z $folder ]]; then
        echo "newer validation: skipped, there is none: it is in Debian's package chromium-common"
        exit 77
    fi
fi
layer=$folder/libVkLayer_khronos_validation.so
[[ -r $layer ]] || { echo "newer validation: $layer cannot be read" >&2 && exit 2; }
echo "newer validation: $layer of $from" >&2

own=$(mktemp -d)
trap 'rm -rf "$own"' EXIT
cat >"$own/VkLayer_khronos_validation.json" <<END
{"file_format_version": "1.2.0",
 "layer": {"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL", "library_path": "$layer", "api_version": "1.3.0",
  "implementation_version": "1", "description": "Khronos validation layer",
  "instance_extensions": [{"name": "VK_EXT_debug_utils", "spec_version": "2"},
                          {"name": "VK_EXT_validation_features", "spec_version": "5"}]}}
END
# Not for the library: what the layer says of its own settings; outputs of a shader that a pass has no image for, which
# Vulkan allows; how glslang lays out arrays of functions, which spirv-val has refused since 2025; and functions of video
# that NVIDIA's own layer asks a device for.
filter=VALIDATION-SETTINGS,WARNING-Setting-Limit-Adjusted,VUID-StandaloneSpirv-None-10684
filter+=,Undefined-Value-ShaderOutputNotConsumed-DynamicRendering,WARNING-Shader-OutputNotConsumed
filter+=,WARNING-vkGetDeviceProcAddr-device
cat >"$own/vk_layer_settings.txt" <<END
khronos_validation.message_id_filter = $filter
khronos_validation.validate_sync = true
END
[[ -z $checks ]] || echo "khronos_validation.gpuav_enable = true" >>"$own/vk_layer_settings.txt"
export VK_LAYER_SETTINGS_PATH=$own/vk_layer_settings.txt
VK_LAYER_PATH=$own "$@"
