// SPDX-License-Identifier: MIT
#include "journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
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

/// A lock on a file that nobody writes any more; -1: there is none to have. It ends with the process, however that
/// ends.
int lock_on(const std::filesystem::path& file) {
    const int lock = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    struct stat held {};
    struct stat there {};
    // Who writes it replaces it.
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) == 0 && ::fstat(lock, &held) == 0 &&
        ::lstat(file.c_str(), &there) == 0 && S_ISREG(there.st_mode) && held.st_ino == there.st_ino)
        return lock;
    if (lock >= 0) ::close(lock);
    return -1;
}

/// Puts a locked file with this text in its place. Nothing there is followed.
Result<int> replace(const std::filesystem::path& file, std::string_view text) {
    const std::filesystem::path beside = file.string() + ".new";
    const auto failed = [&](int lock) {
        Result<int> out = darkroom::machine_error(fmt::format("{}: unsaved edits cannot be kept: {}",
                                                              darkroom::printable(file.string()),
                                                              std::generic_category().message(errno)));
        if (lock >= 0) ::close(lock);
        ::unlink(beside.c_str());
        return out;
    };
    ::unlink(beside.c_str());
    const int lock = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (lock < 0 || ::flock(lock, LOCK_EX | LOCK_NB) != 0) return failed(lock);
    while (!text.empty()) {
        const ssize_t count = ::write(lock, text.data(), text.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return failed(lock);
        text.remove_prefix(static_cast<std::size_t>(count));
    }
    return ::rename(beside.c_str(), file.c_str()) == 0 ? Result<int>(lock) : failed(lock);
}

}  // namespace

Journal::~Journal() {
    for (Held* const held : {&written_, &offered_})
        if (held->lock >= 0) ::close(held->lock);
}

std::filesystem::path Journal::file_of(const darkroom::edit::LookDocument& document, int number) const {
    const std::filesystem::path& file = document.file();
    const std::string end = number == 1 ? "unsaved" : fmt::format("{}.unsaved", number);
    if (!file.empty()) return file.parent_path() / fmt::format(".{}.{}", file.filename().string(), end);
    return folder_.empty() ? folder_ : folder_ / fmt::format("unnamed.{}", end);
}

std::optional<std::string> Journal::left_behind(const darkroom::edit::LookDocument& document) {
    for (int number = 1; number <= max_files; ++number) {
        const std::filesystem::path file = file_of(document, number);
        const int lock = darkroom::check_own_file(file) ? lock_on(file) : -1;
        if (lock < 0) continue;
        const Result<std::string> text = text_of(file);
        if (text && text->starts_with(first_line)) {
            offered_ = {file, lock};
            return text->substr(std::min(text->find('\n'), text->size() - 1) + 1);
        }
        ::close(lock);
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
    DARKROOM_TRY_VALUE(const int lock, replace(file, fmt::format("{}{}\n{}", first_line, getpid(), *text)));
    if (written_.lock >= 0) ::close(written_.lock);
    written_ = {std::move(file), lock};
    version_ = document.version();
    return {};
}

void Journal::remove(Held& held) {
    if (held.lock < 0) return;
    std::error_code error;
    std::filesystem::remove(held.file, error);
    ::close(held.lock);
    held = {};
}

void Journal::end() {
    remove(written_);
    version_ = ~std::uint64_t{0};  // none of the document's
}

}  // namespace app
