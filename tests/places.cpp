// SPDX-License-Identifier: MIT
#include "tests/places.hpp"

namespace darkroom::test {

const char* const source_folder = DARKROOM_SOURCE_FOLDER;
const char* const binary_folder = DARKROOM_BINARY_FOLDER;
const char* const project_version = DARKROOM_PROJECT_VERSION;

}  // namespace darkroom::test
