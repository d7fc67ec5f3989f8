// SPDX-License-Identifier: MIT
#pragma once
// Internal to edit/panels: what the panels of one document share.

#include <darkroom/plan.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "edit/document.hpp"
#include "edit/follow/moved_values.hpp"
#include "panels/widgets/file_browser.hpp"
#include "panels/widgets/messages.hpp"
#include "panels/widgets/widget_places.hpp"

namespace darkroom::panels {

struct Thumbnail;
struct OfferedLooks;

using LookChange = std::function<Result<>(Look&)>;

/// What a file that is chosen is for.
enum class FileKind : std::uint8_t { Table, Picture, Document, Script };

/// A part of the look that is no entry: the interface's own table, a pulse or a layer.
struct LookPart {
    bool is_interface = false;
    edit::Mover mover{};
    bool operator==(const LookPart&) const = default;
};

/// A pulse or a layer that is being put together, or another value of a layer.
struct NewMover {
    bool is_layer = false;
    std::optional<std::size_t> layer{};  ///< gets another value
    std::string name{}, entry{}, parameter{};
};

struct PanelState {
    edit::LookDocument* document = nullptr;
    const Plan* plan = nullptr;
    bool is_compiling = false;
    Messages messages;
    FileBrowser files;
    std::uint64_t selected = 0;      ///< LookEntry::id
    std::optional<LookPart> part{};  ///< is selected in place of an entry
    bool scrolls_to_selected = false;
    std::optional<WidgetPlaces> places{};

    std::string renamed{}, new_name{};  ///< the entry whose name is being typed
    bool is_renaming_new = false;
    std::function<Thumbnail(const EffectInfo& effect)> thumbnails{};
    std::function<std::span<const float>(std::string_view name)> numbers{};
    std::shared_ptr<const OfferedLooks> looks{};
    int adding_frame = -1;                  ///< of ImGui: the last one in which a list with pictures was open
    bool shows_numbers = false;             ///< in place of wheels and curves
    std::string filter{};                   ///< of such a list
    std::size_t add_row = 0;                ///< of that list, where the keyboard is
    std::optional<std::string> fired{};     ///< an event, by its button
    std::string wanted{};                   ///< the entry that an edit has made, to be selected
    std::optional<LookPart> wanted_part{};  ///< the same of a part
    NewMover new_mover{};
    std::uint64_t last_selected = 0;  ///< LookEntry::id: the selected entry, or the one before the part

    struct Edit {
        std::string what;
        LookChange change;
        std::string merge;
    };
    std::optional<Edit> pending{};

    /// What is asked before something is done that nobody would expect.
    struct Question {
        std::string text;
        std::vector<std::pair<std::string, std::function<void()>>> answers;  ///< beside "Cancel"
    };
    std::optional<Question> question{};
    bool is_question_new = false;
    void ask(Question wanted_question) {
        question = std::move(wanted_question);
        is_question_new = true;
    }

    [[nodiscard]] const Look& look() const { return document->look(); }
    /// Done when the panel is drawn: until then, what it draws from stays.
    void edit(std::string what, LookChange change, std::string merge = {}) {
        pending = {std::move(what), std::move(change), std::move(merge)};
    }
    /// Does what the panel that was drawn has asked for.
    void settle();
    void select(std::string_view entry);
    /// Of the last item.
    void note(std::string_view name);
    /// Where the selected entry is; -1: none is selected.
    [[nodiscard]] int selected_index() const;
    /// Asks for a file, which `then` gets as the look would name it.
    void browse(std::string title, FileKind kind, const std::string& present,
                std::function<void(const std::string&)> then);
};

/// Why the plan does without the entry of this name; empty: it has it.
[[nodiscard]] std::string_view left_out(const Plan* plan, std::string_view entry);

// Each panel, into the present window.
void draw_stack_panel(PanelState& state);
void draw_entry_panel(PanelState& state);
/// In its place, where a part is selected that is no entry.
void draw_part_panel(PanelState& state);
void draw_plan_panel(const Plan* plan, bool is_compiling);
/// The popup that lists what can be added, while it is open.
void draw_add_menu(PanelState& state);
/// The popup that lists the looks that can be taken, while it is open.
void draw_looks_menu(PanelState& state);
/// A button that opens the popup in which a pulse, a layer or a value of one is put together. `place`: its name.
void draw_add_mover(PanelState& state, const NewMover& what, const char* label, const char* help,
                    const std::string& place);
/// What is asked, over everything else.
void draw_question(PanelState& state);

}  // namespace darkroom::panels
