// SPDX-License-Identifier: MIT
// A document and its file: reading, saving, and reading again what others have changed.
#include <fmt/format.h>

#include <algorithm>

#include "core/files.hpp"
#include "core/param_text.hpp"
#include "edit/compare.hpp"
#include "edit/document.hpp"
#include "looks/look_stack.hpp"

namespace darkroom::edit {

Result<LookDocument> LookDocument::open(const std::filesystem::path& file, LookOptions options) {
    if (options.folder.empty()) options.folder = file.parent_path();
    Result<Look> look = read_look(file, options);
    if (!look) return failure(std::move(look));
    LookDocument out(std::move(*look), std::move(options));
    out.file_ = file;
    return out;
}

Result<> LookDocument::save() { return user_error("not yet"); }
Result<> LookDocument::save_as(const std::filesystem::path&) { return user_error("not yet"); }
Result<bool> LookDocument::reload_if_changed() { return false; }

}  // namespace darkroom::edit
