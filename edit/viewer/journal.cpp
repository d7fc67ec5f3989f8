// SPDX-License-Identifier: MIT
#include "journal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <span>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"

namespace app {

using darkroom::Result;

namespace {

constexpr std::chrono::milliseconds between_writes{1000};
constexpr std::size_t max_bytes = std::size_t{4} << 20;
constexpr std::string_view first_line = "# Unsaved edits of process ";

Result<std::string> text_of(const std::filesystem::path& file) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, darkroom::read_file(file, {.max_size = max_bytes}));
    const void* const data = bytes.data();
    return std::string(static_cast<const char*>(data), bytes.size());
}

/// One that has ended, and that nobody has asked for its end yet, is not at work any more.
bool is_at_work(long process) {
    const std::string text = text_of(fmt::format("/proc/{}/stat", process)).value_or("");
    const std::size_t end = text.rfind(')');
    return end != std::string::npos && end + 2 < text.size() && text[end + 2] != 'Z' && text[end + 2] != 'X';
}

/// Is the process that the first line names at work?
bool is_being_written(std::string_view text) {
    if (!text.starts_with(first_line)) return false;
    const long process = std::strtol(std::string(text.substr(first_line.size(), 12)).c_str(), nullptr, 10);
    return process != getpid() && is_at_work(process);
}

/// Is it the journal of another window over the look?
bool is_of_another(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error) && darkroom::check_own_file(file) &&
           is_being_written(text_of(file).value_or(""));
}

}  // namespace

std::filesystem::path Journal::file_of(const darkroom::edit::LookDocument& document) const {
    const std::filesystem::path& file = document.file();
    if (!file.empty()) return file.parent_path() / fmt::format(".{}.unsaved", file.filename().string());
    return folder_.empty() ? folder_ : folder_ / "unnamed.unsaved";
}

std::optional<std::string> Journal::left_behind(const darkroom::edit::LookDocument& document) {
    const std::filesystem::path file = file_of(document);
    std::error_code error;
    if (file.empty() || !std::filesystem::exists(file, error) || !darkroom::check_own_file(file)) return std::nullopt;
    const Result<std::string> text = text_of(file);
    if (!text || !text->starts_with(first_line)) return std::nullopt;
    if (is_being_written(*text)) return std::nullopt;
    is_held_ = true;
    return text->substr(std::min(text->find('\n'), text->size() - 1) + 1);
}

void Journal::begin(const darkroom::edit::LookDocument& document) {
    is_held_ = false;
    written_ = file_of(document);
    version_ = ~std::uint64_t{0};  // none of the document's
}

Result<> Journal::follow(const darkroom::edit::LookDocument& document) {
    const Clock::time_point now = Clock::now();
    if (is_held_ || has_failed_ || now - looked_at_ < between_writes) return state_;
    looked_at_ = now;
    return state_ = keep(document);
}

Result<> Journal::keep(const darkroom::edit::LookDocument& document) {
    const std::filesystem::path file = file_of(document);
    if (!document.is_changed() || file != written_) end();
    if (!document.is_changed() || file.empty() || (version_ == document.version() && !written_.empty())) return {};
    const Result<std::string> text = document.unsaved_text();
    if (!text) return {};  // saving says why
    if (is_of_another(file))
        return darkroom::user_error(fmt::format("{}: unsaved edits are not kept while another window keeps its own",
                                                darkroom::printable(file.string())));
    std::error_code error;
    if (document.file().empty()) std::filesystem::create_directories(folder_, error);
    const std::string all = fmt::format("{}{}\n{}", first_line, getpid(), *text);
    if (Result<> done = darkroom::write_own_file(file, std::as_bytes(std::span(all))); !done) {
        has_failed_ = true;
        return done;
    }
    written_ = file;
    version_ = document.version();
    return {};
}

void Journal::end() {
    if (written_.empty()) return;
    std::error_code error;
    if (!is_of_another(written_)) std::filesystem::remove(written_, error);
    written_.clear();
}

}  // namespace app
