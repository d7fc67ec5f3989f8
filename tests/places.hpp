// SPDX-License-Identifier: MIT
#pragma once
// Where the tree and its build lie. Known to places.cpp alone: a compiler's cache keeps files that are told a folder
// apart for every checkout.

namespace darkroom::test {

extern const char* const source_folder;
extern const char* const binary_folder;
extern const char* const project_version;

}  // namespace darkroom::test
