// SPDX-License-Identifier: MIT
#pragma once
// Files that come with the program: beside the sources that it was built from, or installed with it.

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// "samples/window.exr". Empty: it is not there.
[[nodiscard]] std::filesystem::path shipped_file(const std::filesystem::path& name);

/// The files of the looks that ship, by name.
[[nodiscard]] std::vector<std::filesystem::path> shipped_looks();

/// Turns the name of a look that ships ("night") into its file. What names a file or a folder stays. Returns what is
/// wrong: neither a file nor such a name; empty: nothing.
[[nodiscard]] std::string find_shipped_look(std::string& name);

}  // namespace app
