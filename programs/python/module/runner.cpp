// SPDX-License-Identifier: MIT
// A look on the device: arrays go in, developed pictures come out. The interpreter's lock is released while the library
// works; who comes from two threads at once waits.
#include "runner.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "arrays.hpp"
#include "core/text/param_text.hpp"
#include "parts.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

Matrix matrix_of(const py::handle& object) {
    const auto rows = py::cast<py::array_t<float, py::array::forcecast | py::array::c_style>>(object);
    Matrix out{};
    for (py::ssize_t row = 0; row < 4; ++row)
        for (py::ssize_t column = 0; column < 4; ++column)
            out[static_cast<std::size_t>(column * 4 + row)] = rows.at(row, column);
    return out;
}

/// As darkroom.Camera describes it.
Camera camera_of(const py::dict& given) {
    return {.view = matrix_of(given["view"]),
            .projection = matrix_of(given["projection"]),
            .previous_view = matrix_of(given["previous_view"]),
            .previous_projection = matrix_of(given["previous_projection"]),
            .near_distance = given["near"].cast<float>(),
            .far_distance = given["far"].cast<float>(),
            .depth = DepthKind::Planar,
            .jitter = given["jitter"].cast<std::array<float, 2>>(),
            .previous_jitter = given["previous_jitter"].cast<std::array<float, 2>>(),
            .is_cut = given["is_cut"].cast<bool>()};
}

std::array<float, 3> three(const py::handle& given) { return given.cast<std::array<float, 3>>(); }

/// As darkroom.Light describes it, which has looked at counts and shapes.
ReferenceLight light_of(const py::dict& given) {
    ReferenceLight out{.light = {.direction = three(given["direction"]),
                                 .color = three(given["color"]),
                                 .volumetric_intensity = given["volumetric_intensity"].cast<float>(),
                                 .volumetric_color = three(given["volumetric_color"])}};
    const auto matrices = given["world_to_cascade"].cast<py::list>();
    const auto splits = given["splits"].cast<std::vector<float>>();
    for (const py::handle cascade : given["cascades"]) {
        const Layer depths = read_layer(py::reinterpret_borrow<py::object>(cascade), {"cascade", 1, 1, false, false});
        const std::span<const float> values = depths.samples<float>();
        const std::size_t number = out.cascades.size();
        out.cascades.emplace_back(values.begin(), values.end());
        out.resolution = depths.extent.width;
        out.light.world_to_cascade.at(number) = matrix_of(matrices[number]);
        out.light.splits.at(number) = splits.at(number);
        ++out.light.cascade_count;
    }
    return out;
}

/// The arrays of a frame, which live as long as the input that refers to them.
struct FrameArrays {
    std::vector<Layer> kept;
    std::vector<ReferenceLight> lights;
    DevelopInput input;
    Moves moves;
    float exposure = 1;

    Layer add(const py::object& object, const LayerRules& rules, VkExtent2D extent) {
        Layer layer = read_layer(object, rules);
        if (extent.width != 0 && (layer.extent.width != extent.width || layer.extent.height != extent.height))
            raise_user(fmt::format("{}: {}x{} pixels: allowed is {}x{}", rules.name, layer.extent.width,
                                   layer.extent.height, extent.width, extent.height));
        kept.push_back(layer);
        return layer;
    }
};

FrameArrays arrays_of(const py::dict& frame, VkExtent2D target_extent) {
    FrameArrays out;
    DevelopInput& input = out.input;
    const Layer color = out.add(frame["color"], {.name = "color"}, {});
    const VkExtent2D extent = input.extent = color.extent;
    input.color = color.samples<float>();
    input.color_halves = color.samples<std::uint16_t>();
    input.color_codes = color.samples<std::uint8_t>();
    input.color_channels = color.channels;
    const auto numbers = [&](const char* name, std::uint32_t channels) -> std::span<const float> {
        if (!frame.contains(name)) return {};
        return out.add(frame[name], {name, channels, channels, false, false}, extent).samples<float>();
    };
    input.depth = numbers("depth", 1);
    input.normals = numbers("normals", 3);
    input.reactive = numbers("reactive", 1);
    input.transparency = numbers("transparency", 3);
    if (frame.contains("velocity")) {
        const Layer velocity = out.add(frame["velocity"], {"velocity", 2, 2, false, true}, extent);
        input.velocity = velocity.samples<float>();
        input.velocity_halves = velocity.samples<std::uint16_t>();
    }
    if (frame.contains("ui"))
        input.ui = out.add(frame["ui"], {"ui", 4, 4, true, false}, target_extent.width == 0 ? extent : target_extent)
                       .samples<std::uint8_t>();
    if (frame.contains("ui") && input.ui.empty()) raise_user("ui: dtype float32: allowed is uint8");
    if (frame.contains("exposure")) out.exposure = frame["exposure"].cast<float>();
    for (const py::handle light : frame["lights"]) out.lights.push_back(light_of(light.cast<py::dict>()));
    input.lights = out.lights;
    input.camera = camera_of(frame["camera"]);
    input.time = frame["time"].cast<double>();
    input.delta_time = frame["delta_time"].cast<double>();
    input.frame_index = frame["frame_index"].cast<std::uint64_t>();
    out.moves = {.fire = frame["fire"].cast<std::vector<std::string>>(),
                 .layer_weights = frame["layer_weights"].cast<std::map<std::string, float>>()};
    return out;
}

py::array array_of_picture(DevelopedPicture picture, std::uint32_t channels) {
    if (!picture.bytes.empty()) return array_of(std::move(picture.bytes), picture.extent, channels);
    return array_of(std::move(picture.pixels), picture.extent, channels);
}

/// What nobody asked for and hides the steps of 8 bits alone.
Look suited(Look look, DevelopTarget target) {
    for (LookEntry& entry : look.entries)
        if (target != DevelopTarget::Encoded8 && look.is_flat && entry.effect->is_last_step &&
            entry.effect->makes == nullptr && !entry.is_asked_for)
            entry.state.enabled = false;
    return look;
}

}  // namespace

std::shared_ptr<Device> create_device(const std::string& select, bool validate) {
    const py::gil_scoped_release others_run;
    // To standard error, not to Python: a sink must not wait for the interpreter's lock.
    const auto log = [](Severity severity, std::string_view text) {
        if (severity >= Severity::Warning) fmt::print(stderr, "darkroom: {}\n", text);
    };
    Result<Device> device = Device::create({.select = select, .validate = validate, .log = log});
    if (!device) {
        const py::gil_scoped_acquire lock;
        raise(device.error());
    }
    return std::make_shared<Device>(std::move(*device));
}

Runner::Runner(std::shared_ptr<Device> device, DevelopTarget target, std::uint32_t frames_in_flight,
               VkExtent2D target_extent)
    : device_(std::move(device)),
      desc_{.target = target, .target_extent = target_extent, .frames_in_flight = frames_in_flight} {}

Runner::~Runner() {
    const py::gil_scoped_release others_run;
    developer_.reset();
    composer_.reset();
}

Result<> Runner::follow(const EditedLook& edits) {
    if (composer_ && edits.edition == edition_) return {};
    Look wanted = suited(edits.look, desc_.target);
    bool needs_compile = true;
    if (!composer_) {
        Composer composer(*device_, {.frames_in_flight = desc_.frames_in_flight});
        DARKROOM_TRY(apply(wanted, composer));
        composer_.emplace(std::move(composer));
    } else {
        DARKROOM_TRY_VALUE(const Followed followed, darkroom::follow(look_, wanted, *composer_));
        needs_compile = followed.needs_compile;
    }
    look_ = std::move(wanted);
    edition_ = edits.edition;
    if (needs_compile) {
        while (developer_ && developer_->in_flight() > 0) finished_.push_back(developer_->finish());
        developer_.emplace(*device_, desc_);
    }
    return {};
}

Result<> Runner::move(const Moves& moves) {
    for (const std::string& event : moves.fire) {
        std::vector<std::string> events;
        for (const LookPulse& pulse : look_.pulses) events.push_back(pulse.event);
        if (std::ranges::count(events, event) == 0)
            return user_error(fmt::format("fire = \"{}\": no pulse of {} has this event{}", printable(event),
                                          look_.shown_name, alternatives(event, events, "there are")));
    }
    std::vector<std::string> names;
    for (const LookLayer& layer : look_.layers) names.push_back(layer.name);
    for (const auto& [name, weight] : moves.layer_weights)
        if (std::ranges::count(names, name) == 0)
            return user_error(fmt::format("layer_weights: {} has no layer '{}'{}", look_.shown_name, printable(name),
                                          alternatives(name, names, "it has")));
    for (const LookLayer& layer : look_.layers) {
        const auto given = moves.layer_weights.find(layer.name);
        const float weight = given == moves.layer_weights.end() ? layer.state.weight : given->second;
        DARKROOM_TRY(composer_->set_layer_weight(layer.name, weight));
    }
    for (const std::string& event : moves.fire) composer_->fire(event);
    return {};
}

Result<> Runner::submit_locked(const EditedLook& edits, const DevelopInput& input, const Moves& moves) {
    DARKROOM_TRY(follow(edits));
    DARKROOM_TRY(move(moves));
    return developer_->submit(*composer_, input);
}

Result<DevelopedPicture> Runner::finish_locked() {
    if (finished_.empty()) return developer_->finish();
    Result<DevelopedPicture> oldest = std::move(finished_.front());
    finished_.pop_front();
    return oldest;
}

void Runner::submit(const EditedLook& edits, const py::dict& frame) {
    if (channels_.size() >= desc_.frames_in_flight)
        raise_user(fmt::format("sequence: {} frames are under way: finish one first", channels_.size()));
    FrameArrays arrays = arrays_of(frame, desc_.target_extent);
    if (frame.contains("exposure")) arrays.input.exposure = {&arrays.exposure, 1};
    const EditedLook kept = edits;  // another thread may edit it meanwhile
    Result<> done{};
    {
        const py::gil_scoped_release others_run;
        const std::lock_guard lock(mutex_);
        done = submit_locked(kept, arrays.input, arrays.moves);
    }
    must(done);
    channels_.push_back(arrays.input.color_channels);
}

py::array Runner::finish() {
    if (channels_.empty()) raise_user("sequence: no frame is under way");
    Result<DevelopedPicture> picture = [&] {
        const py::gil_scoped_release others_run;
        const std::lock_guard lock(mutex_);
        return finish_locked();
    }();
    const std::uint32_t channels = channels_.front();
    channels_.pop_front();
    return array_of_picture(must(std::move(picture)), channels);
}

py::array Runner::develop(const EditedLook& edits, const py::dict& frame) {
    FrameArrays arrays = arrays_of(frame, desc_.target_extent);
    if (frame.contains("exposure")) arrays.input.exposure = {&arrays.exposure, 1};
    const EditedLook kept = edits;
    Result<DevelopedPicture> picture = [&]() -> Result<DevelopedPicture> {
        const py::gil_scoped_release others_run;
        const std::lock_guard lock(mutex_);
        DARKROOM_TRY(submit_locked(kept, arrays.input, arrays.moves));
        return finish_locked();
    }();
    return array_of_picture(must(std::move(picture)), arrays.input.color_channels);
}

Plan Runner::plan() {
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    return developer_ ? developer_->plan() : Plan();
}

std::vector<std::string> Runner::told(std::vector<std::string> Plan::*list) {
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    const Plan* const plan = composer_ ? composer_->current_plan() : nullptr;
    return plan == nullptr ? std::vector<std::string>() : plan->*list;
}

void add_runner(py::module_& module) {
    py::class_<Device, std::shared_ptr<Device>>(module, "Device")
        .def(py::init(&create_device))
        .def_property_readonly("name", [](const Device& device) { return device.info().name; })
        .def_property_readonly("driver", [](const Device& device) { return device.info().driver; })
        .def_property_readonly("is_software", [](const Device& device) { return device.info().is_software; })
        .def_property_readonly("validation_messages", &Device::validation_messages);
    module.def("devices", [] {
        py::list out;
        for (const DeviceInfo& info : must(Device::list())) {
            py::dict one;
            one["index"] = info.index;
            one["name"] = info.name;
            one["driver"] = info.driver;
            one["is_software"] = info.is_software;
            one["is_usable"] = info.is_usable;
            one["reason"] = info.reason;
            out.append(one);
        }
        return out;
    });
    py::enum_<DevelopTarget>(module, "Target")
        .value("encoded8", DevelopTarget::Encoded8)
        .value("encoded", DevelopTarget::EncodedFloat)
        .value("linear", DevelopTarget::SceneLinear);
    py::class_<Runner>(module, "Runner")
        .def(py::init([](std::shared_ptr<Device> device, DevelopTarget target, std::uint32_t frames_in_flight,
                         std::pair<std::uint32_t, std::uint32_t> size) {
            return std::make_unique<Runner>(std::move(device), target, frames_in_flight,
                                            VkExtent2D{size.first, size.second});
        }))
        .def("develop", &Runner::develop)
        .def("submit", &Runner::submit)
        .def("finish", &Runner::finish)
        .def("plan_text", [](Runner& runner) { return runner.plan().text(); })
        .def("plan_json", [](Runner& runner) { return runner.plan().json(); })
        .def("left_out", [](Runner& runner) { return runner.told(&Plan::left_out); })
        .def("misplaced", [](Runner& runner) { return runner.told(&Plan::misplaced); });
}

}  // namespace darkroom::python
