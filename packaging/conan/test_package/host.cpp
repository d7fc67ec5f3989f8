// SPDX-License-Identifier: MIT
#include <darkroom/darkroom.hpp>

int main() {
    return darkroom::find_effect("bloom") == nullptr ? 1 : 0;
}
