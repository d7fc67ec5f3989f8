// SPDX-License-Identifier: MIT
#pragma once
// Tables that a table names: a CLF or CTF may be made of others, by <Reference path="...">, which OpenColorIO opens by
// itself. They are looked for here before it is let at the file.

#include <darkroom/result.hpp>
#include <filesystem>

namespace darkroom {

/// That every file the table names, and those that these name, is a regular one in the table's folder or below. The
/// text is read as OpenColorIO reads it, by expat: after entities and character references, and up to the first fault.
[[nodiscard]] Result<> check_references(const std::filesystem::path& table);

}  // namespace darkroom
