// SPDX-License-Identifier: MIT
#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace app {

std::optional<std::string> completed(const std::vector<std::string>& names) {
    if (names.empty()) return std::nullopt;
    std::string out = names.front();
    for (const std::string& name : names) {
        const auto [end, other] = std::mismatch(out.begin(), out.end(), name.begin(), name.end());
        out.erase(end, out.end());
    }
    return names.size() == 1 ? out + ' ' : out;
}

std::optional<std::string> CommandLine::draw(const Names& names, const Print& print) {
    std::array<char, longest> text{};
    typed_.copy(text.data(), text.size() - 1);
    Call call{*this, names, print};
    const bool is_entered =
        ImGui::InputText("##command", text.data(), text.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                             ImGuiInputTextFlags_CallbackHistory,
                         on_key, &call);
    typed_ = text.data();
    if (!is_entered || typed_.empty()) return std::nullopt;
    recalled_ = 0;
    std::erase(kept_, typed_);
    kept_.push_back(typed_);
    if (kept_.size() > max_kept) kept_.pop_front();
    return std::exchange(typed_, {});
}

int CommandLine::on_key(ImGuiInputTextCallbackData* data) {
    const Call& call = *static_cast<Call*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) call.own.complete(*data, call);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory)
        call.own.recall(*data, data->EventKey == ImGuiKey_UpArrow);
    return 0;
}

void CommandLine::complete(ImGuiInputTextCallbackData& data, const Call& call) const {
    const std::string_view before(data.Buf, static_cast<std::size_t>(data.CursorPos));
    const std::size_t begin = before.find_last_of(" ;\"") + 1;
    const std::vector<std::string> names = call.names(before.substr(begin));
    const std::optional<std::string> word = completed(names);
    if (!word) return;
    if (names.size() > 1 && *word == before.substr(begin)) {
        constexpr std::size_t most = 40;
        const std::size_t shown = std::min(names.size(), most);
        call.print(fmt::format("{}{}",
                               fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), "  "),
                               names.size() > most ? fmt::format("  and {} more", names.size() - most) : ""));
        return;
    }
    data.DeleteChars(static_cast<int>(begin), data.CursorPos - static_cast<int>(begin));
    data.InsertChars(data.CursorPos, word->c_str());
}

void CommandLine::recall(ImGuiInputTextCallbackData& data, bool is_back) {
    if (is_back ? recalled_ == kept_.size() : recalled_ == 0) return;
    if (recalled_ == 0) begun_.assign(data.Buf, static_cast<std::size_t>(data.BufTextLen));
    recalled_ += is_back ? 1 : std::size_t(-1);
    const std::string& text = recalled_ == 0 ? begun_ : kept_[kept_.size() - recalled_];
    data.DeleteChars(0, data.BufTextLen);
    data.InsertChars(0, text.c_str());
}

darkroom::Result<std::vector<std::string>> LineInput::take() {
    std::vector<std::string> lines;
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (!is_open_ || poll(&input, 1, 0) <= 0) return lines;
    std::array<char, 4096> some{};
    const ssize_t count = read(STDIN_FILENO, some.data(), some.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return lines;
    is_open_ = count > 0;
    begun_.append(some.data(), is_open_ ? static_cast<std::size_t>(count) : 0);
    if (!is_open_) begun_ += '\n';
    std::size_t begin = 0, longest = 0;
    for (std::size_t end = 0; (end = begun_.find('\n', begin)) != std::string::npos; begin = end + 1) {
        if (end > begin) lines.push_back(begun_.substr(begin, end - begin));
        longest = std::max(longest, end - begin);
    }
    begun_.erase(0, begin);
    if (std::max(longest, begun_.size()) <= longest_line) return lines;
    is_open_ = false;
    return darkroom::user_error(
        fmt::format("standard input: a line is longer than {} characters, no more are read", longest_line));
}

}  // namespace app
