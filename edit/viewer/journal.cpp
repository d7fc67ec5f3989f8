// SPDX-License-Identifier: MIT
#include "journal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <span>
#include <system_error>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"

namespace app {

using darkroom::Result;

namespace {

constexpr std::chrono::milliseconds between_writes{1000};
constexpr std::size_t max_bytes = std::size_t{4} << 20;
constexpr std::string_view first_line = "# Unsaved edits of process ";

/// Of one look: of windows over it that are open, and of those that ended before their edits were taken.
constexpr int max_files = 9;

Result<std::string> text_of(const std::filesystem::path& file) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, darkroom::read_file(file, {.max_size = max_bytes}));
    const void* const data = bytes.data();
    return std::string(static_cast<const char*>(data), bytes.size());
}

}  // namespace

std::filesystem::path Journal::file_of(const darkroom::edit::LookDocument& document, int number) const {
    const std::filesystem::path& file = document.file();
    const std::string end = number == 1 ? "unsaved" : fmt::format("{}.unsaved", number);
    if (!file.empty()) return file.parent_path() / fmt::format(".{}.{}", file.filename().string(), end);
    return folder_.empty() ? folder_ : folder_ / fmt::format("unnamed.{}", end);
}

std::optional<std::string> Journal::left_behind(const darkroom::edit::LookDocument& document) {
    for (int number = 1; number <= max_files; ++number) {
        const std::filesystem::path file = file_of(document, number);
        darkroom::FileLock lock = darkroom::lock_own_file(file);
        const Result<std::string> text = lock ? text_of(file) : Result<std::string>();
        if (!text || !text->starts_with(first_line)) continue;
        offered_ = {file, std::move(lock)};
        return text->substr(std::min(text->find('\n'), text->size() - 1) + 1);
    }
    return std::nullopt;
}

Result<> Journal::follow(const darkroom::edit::LookDocument& document) {
    const Clock::time_point now = Clock::now();
    if (now - looked_at_ < between_writes) return state_;
    looked_at_ = now;
    return state_ = keep(document);
}

Result<> Journal::keep(const darkroom::edit::LookDocument& document) {
    if (!document.is_changed() || document.file() != of_) end();
    of_ = document.file();
    if (!document.is_changed() || file_of(document, 1).empty() || version_ == document.version()) return {};
    const Result<std::string> text = document.unsaved_text();
    if (!text) return {};  // saving says why
    std::error_code error;
    if (of_.empty()) std::filesystem::create_directories(folder_, error);
    std::filesystem::path file = written_.file;
    for (int number = 1; file.empty() && number <= max_files; ++number)
        if (!std::filesystem::exists(std::filesystem::symlink_status(file_of(document, number), error)))
            file = file_of(document, number);
    if (file.empty())
        return darkroom::user_error(fmt::format("{}: there are {} files of unsaved edits beside it: these are not kept",
                                                darkroom::printable(file_of(document, 1).string()), max_files));
    const std::string all = fmt::format("{}{}\n{}", first_line, getpid(), *text);
    DARKROOM_TRY_VALUE(darkroom::FileLock lock, darkroom::write_locked_file(file, std::as_bytes(std::span(all))));
    written_ = {std::move(file), std::move(lock)};
    version_ = document.version();
    return {};
}

void Journal::remove(Held& held) {
    std::error_code error;
    if (held.lock) std::filesystem::remove(held.file, error);
    held = {};
}

void Journal::end() {
    remove(written_);
    version_ = ~std::uint64_t{0};  // none of the document's
}

}  // namespace app
