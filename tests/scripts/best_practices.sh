#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# best_practices.sh LIST COMMAND...: runs a command under the best practices of the validation layer and of the vendors
# that it knows. What LIST (docs/best_practices.md) has in its table is muted, so that any other finding is a message,
# which fails a test, and ends the command line with 2. LIST may be /dev/null: all is said.
set -euo pipefail
list=$1
shift
vendors=VALIDATION_CHECK_ENABLE_VENDOR_SPECIFIC
export DARKROOM_VALIDATE=1 VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT
# Arm's check of blending crashes where a multisampled pipeline has no render pass (layer 1.3.239).
for vendor in ${DARKROOM_VENDORS:-AMD ARM IMG NVIDIA}; do VK_LAYER_ENABLES+=:${vendors}_$vendor; done
# Up to 1.3.2xx a message's name is UNASSIGNED-BestPractices-NAME, later BestPractices-NAME or BestPractices-VENDOR-NAME.
VK_LAYER_MESSAGE_ID_FILTER=$(sed -nE 's/^\| (`[^|]*`) \|.*/\1/p' "$list" | { grep -oE '[A-Za-z0-9_-]+' || true; } |
    sed -E 's/.*/UNASSIGNED-BestPractices-&\nBestPractices-&\nBestPractices-AMD-&\nBestPractices-Arm-&\nBestPractices-NVIDIA-&/' | paste -sd:)
export VK_LAYER_MESSAGE_ID_FILTER
exec "$@"
