// SPDX-License-Identifier: MIT
#pragma once
// Unsaved edits of a look, kept in a file beside it while they are not saved, so that a program that ends without being
// asked loses none. Who writes it holds a lock on it. Several windows over one look have one each.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "core/own_file.hpp"
#include "edit/document.hpp"

namespace app {

class Journal {
  public:
    /// `folder`: of looks that have no file yet; empty: these have no journal.
    explicit Journal(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// What a former process has left of this look, and nobody writes any more: as LookDocument::take_unsaved reads it.
    /// It stays where it is, and is offered again at the next time, until it is settled.
    [[nodiscard]] std::optional<std::string> left_behind(const darkroom::edit::LookDocument& document);
    /// That was taken, or is not wanted.
    void settle() { remove(offered_); }
    /// Once a frame: what is not saved is in the file within a second or two, and where all is saved there is none.
    /// Errors, as long as they last: the file cannot be written.
    [[nodiscard]] darkroom::Result<> follow(const darkroom::edit::LookDocument& document);
    /// Of who leaves and means it.
    void end();

  private:
    using Clock = std::chrono::steady_clock;
    struct Held {
        std::filesystem::path file;
        darkroom::FileLock lock;  ///< none: there is no file
    };
    /// Empty: there is none.
    [[nodiscard]] std::filesystem::path file_of(const darkroom::edit::LookDocument& document, int number) const;
    static void remove(Held& held);
    [[nodiscard]] darkroom::Result<> keep(const darkroom::edit::LookDocument& document);

    std::filesystem::path folder_, of_;  ///< of_: the look's
    Held written_, offered_;
    std::uint64_t version_ = ~std::uint64_t{0};  ///< of the document, in the file
    Clock::time_point looked_at_{};
    darkroom::Result<> state_;
};

}  // namespace app
