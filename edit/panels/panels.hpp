// SPDX-License-Identifier: MIT
#pragma once
// The panels over a look that is edited: its stack, the parameters of the effect that is selected, the plan that
// follows from them, undo and saving. They are drawn from the effects' own descriptions, and change nothing but the
// document; whoever has a Composer takes it along with darkroom::follow.
//
//     darkroom::panels::LookPanels panels(document);
//     panels.set_plan(composer.current_plan(), composer.pending().is_pending);   // every frame
//     ImGui::Begin("Stack");
//     panels.draw_stack();
//     ImGui::End();
//     ...                          // draw_bar, draw_messages, draw_entry and draw_plan, each in a window of the host's
//     panels.draw_popups();        // last, outside of windows
//     if (document.version() != seen) ...                                        // follow, compile_later
//
// Each draws into the host's present window, at its cursor and as wide as the window, of 18 times the font's size at
// least. A host that wants the same look applies panels/widgets/theme.hpp.

#include <darkroom/plan.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "edit/document.hpp"
#include "panels/widgets/file_browser.hpp"
#include "panels/widgets/messages.hpp"
#include "panels/widgets/widget_places.hpp"

namespace darkroom::panels {

struct PanelState;

/// A picture as ImGui's texture; null: it is on its way.
struct Thumbnail {
    void* texture = nullptr;
    float aspect = 1;     ///< width / height
    std::string error{};  ///< why there will be none
};
/// What an effect that is added would make of the picture.
using ThumbnailOf = std::function<Thumbnail(const EffectInfo& effect)>;
/// Looks that can be taken in place of the one that is edited.
struct OfferedLooks {
    std::vector<std::filesystem::path> files;
    std::function<Result<Look>(const std::filesystem::path& file)> read;
    /// What it makes of the picture; asked in every frame, of those that are seen.
    std::function<Thumbnail(const std::filesystem::path& file)> picture;
};
/// The numbers of a value that the host's Composer has (Composer::value); none: it has none.
using NumbersOf = std::function<std::span<const float>(std::string_view name)>;

class LookPanels {
  public:
    /// The document must outlive the panels, or be replaced by show().
    explicit LookPanels(edit::LookDocument& document);
    LookPanels(LookPanels&&) noexcept;
    LookPanels& operator=(LookPanels&&) noexcept;
    ~LookPanels();

    void show(edit::LookDocument& document);
    /// What the stack became, null where it is not known yet; and whether another plan is on its way.
    void set_plan(const Plan* plan, bool is_compiling = false);

    /// One row: undo, redo, save, save as, revert, and the file's name, marked where it is to be saved.
    void draw_bar();
    /// Takes no room where there is nothing to say; messages().height() says how much it takes.
    void draw_messages();
    /// All that was said, newest first.
    void draw_history();
    /// The entries in their order, the interface's chain apart.
    void draw_stack();
    /// Parameters, opacity, blend mode and wires of the selected entry.
    void draw_entry();
    /// Passes and what they hold, remarks, memory.
    void draw_plan();
    /// The file browser, while a file is being chosen; what is asked.
    void draw_popups();

    // What the bar's buttons do, for a host's keys. What goes wrong becomes a message.
    void undo();
    void redo();
    /// Asks for a name where there is none yet.
    void save();
    void save_as();
    /// To what the file says: a step of undo.
    void revert();

    /// Where the look's files are.
    [[nodiscard]] const std::filesystem::path& folder() const;
    /// An event whose pulses are to be fired.
    [[nodiscard]] std::optional<std::string> take_fired();
    /// Asks something over everything else; each answer with what it does, beside "Cancel".
    void ask(std::string text, std::vector<std::pair<std::string, std::function<void()>>> answers);
    [[nodiscard]] Messages& messages();
    [[nodiscard]] FileBrowser& files();
    /// Name of the selected entry; empty: none.
    [[nodiscard]] std::string selected() const;
    void select(std::string_view entry);
    /// For the list of effects that can be added: asked in every frame, of those that are seen.
    void set_thumbnails(ThumbnailOf thumbnails);
    /// For effects that tell what they meter: asked in every frame, of the selected one.
    void set_numbers(NumbersOf numbers);
    void set_looks(OfferedLooks looks);
    /// Is one of those lists open?
    [[nodiscard]] bool is_adding() const;
    /// Effects whose parameters have wheels and curves show lines of numbers instead.
    void show_numbers(bool shows_numbers);
    /// Where widgets are, noted from now on while they are drawn.
    [[nodiscard]] const WidgetPlaces& places();
    /// The item that was drawn last, a host's own, is among them from now on.
    void note_place(std::string_view name);
    void note_place(std::string_view name, const WidgetPlace& place);

  private:
    std::unique_ptr<PanelState> state_;
};

}  // namespace darkroom::panels
