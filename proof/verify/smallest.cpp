// SPDX-License-Identifier: MIT
#include "verify/smallest.hpp"

#include <algorithm>

namespace darkroom::verify {

namespace {

class Search {
  public:
    Search(Finding& finding, const Shows& shows, std::size_t tries)
        : finding_(finding), shows_(shows), tries_(tries), form_(finding.form) {
        finding_.smallest = finding.subject;
        finding_.smallest_extent = finding.form.extent;
    }

    void run() {
        drop_steps();
        take_back_values();
        halve_sides();
    }

  private:
    [[nodiscard]] bool still_shows(const Subject& subject, VkExtent2D extent) {
        if (tries_ == 0) return false;
        --tries_;
        form_.extent = extent;
        return shows_(subject, form_);
    }
    [[nodiscard]] bool keep_if_it_shows(Subject subject) {
        if (!still_shows(subject, finding_.smallest_extent)) return false;
        finding_.smallest = std::move(subject);
        return true;
    }

    void drop_steps() {
        for (std::size_t i = finding_.smallest.steps.size(); i-- > 0 && finding_.smallest.steps.size() > 1;) {
            Subject fewer = finding_.smallest;
            fewer.steps.erase(fewer.steps.begin() + static_cast<std::ptrdiff_t>(i));
            static_cast<void>(keep_if_it_shows(std::move(fewer)));
        }
    }

    void take_back_values() {
        for (std::size_t i = 0; i < finding_.smallest.steps.size(); ++i)
            for (const ParamInfo& row : finding_.smallest.steps[i].info->parameters.rows) {
                Subject plainer = finding_.smallest;
                Step& step = plainer.steps[i];
                const auto defaults = step.info->parameters.defaults.subspan(row.word, row.words);
                const auto present = std::span(step.words).subspan(row.word, row.words);
                if (std::ranges::equal(defaults, present)) continue;
                std::ranges::copy(defaults, present.begin());
                const bool is_wrong = step.info->conflict != nullptr && !step.info->conflict(step.words.data()).empty();
                if (!is_wrong && is_seen(*step.info, step.words))
                    static_cast<void>(keep_if_it_shows(std::move(plainer)));
            }
    }

    void halve_sides() {
        for (const bool is_width : {true, false})
            while (true) {
                VkExtent2D extent = finding_.smallest_extent;
                std::uint32_t& side = is_width ? extent.width : extent.height;
                if (side == 1) break;
                side /= 2;
                if (!still_shows(finding_.smallest, extent)) break;
                finding_.smallest_extent = extent;
            }
    }

    Finding& finding_;
    const Shows& shows_;
    std::size_t tries_;
    Form form_;
};

}  // namespace

void make_smaller(Finding& finding, const Shows& shows, std::size_t max_tries) {
    Search(finding, shows, max_tries).run();
}

}  // namespace darkroom::verify
