// SPDX-License-Identifier: MIT
// How much of a frame is made anew: of a picture that moves fewer pixels, of one that stands nothing.
#include "viewer_state.hpp"

namespace app {

namespace {

/// A picture that has not changed for so long is drawn whole.
constexpr std::chrono::milliseconds to_rest{300};

}  // namespace

// What is measured, watched or stored is the whole picture.
bool Viewer::is_looked_into() const {
    if (!wanted_.pictures.empty() || !wanted_.window.empty() || !wanted_.frame.empty()) return true;
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr) return false;
    const auto& look = views_[static_cast<std::size_t>(Side::Look)];
    return panels->pixel() || (look && panels->watched(look->composer().current_plan()) != nullptr);
}

std::uint32_t Viewer::choose_divisor() {
    const std::chrono::duration<double> still = last_turn_ - moved_at_;
    const bool is_over = still > to_rest + std::chrono::duration<double>(has_rested_ ? 0 : passed_);
    if (source_->is_another(moment()) || developed_version_ != document_->version()) {
        moves_ = has_rested_ && is_over ? 1 : moves_ + 1;
        moved_at_ = last_turn_;
    } else if (is_over) {
        moves_ = 0;
    }
    if (divisor_ == preview_.divisor() && has_developed_ && !has_rested_) preview_.add(passed_);
    // A single step, such as a switch, is shown as it is.
    return moves_ > 1 && !job_.is_full_size && !is_fixed() && !is_looked_into() ? preview_.divisor() : 1;
}

bool Viewer::has_come_to_rest() const { return divisor_ > 1 && Clock::now() - moved_at_ > to_rest; }

bool Viewer::is_picture_kept() const {
    return !is_fixed() && !is_time_running() && !is_looked_into() && !is_cut_ && source_->is_kept() &&
           !interface_->is_new() && developed_version_ == document_->version();
}

}  // namespace app
