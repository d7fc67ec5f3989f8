// SPDX-License-Identifier: MIT
#pragma once
// Unsaved edits of a look, kept in a file beside it while they are not saved, so that a program that ends without being
// asked loses none. Its first line names the process that writes it.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "edit/document.hpp"

namespace app {

class Journal {
  public:
    /// `folder`: of looks that have no file yet; empty: these have no journal.
    explicit Journal(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// What a former process has left of this look, and nobody writes any more: as LookDocument::take_unsaved reads it.
    /// Nothing is written before begin().
    [[nodiscard]] std::optional<std::string> left_behind(const darkroom::edit::LookDocument& document);
    /// It is dealt with: from now on the file is ours, and edits are written.
    void begin(const darkroom::edit::LookDocument& document);
    /// Once a frame: what is not saved is in the file within a second or two, and where all is saved there is none.
    /// Errors, as long as they last: the file cannot be written, or is another window's.
    [[nodiscard]] darkroom::Result<> follow(const darkroom::edit::LookDocument& document);
    /// Of who leaves and means it.
    void end();

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] darkroom::Result<> keep(const darkroom::edit::LookDocument& document);
    [[nodiscard]] std::filesystem::path file_of(const darkroom::edit::LookDocument& document) const;

    std::filesystem::path folder_, written_;  ///< written_: the file that is there, ours
    std::uint64_t version_ = 0;               ///< of the document, in it
    Clock::time_point looked_at_{};
    bool is_held_ = false, has_failed_ = false;
    darkroom::Result<> state_;
};

}  // namespace app
