// SPDX-License-Identifier: MIT
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <fmt/format.h>

#include <exception>
#include <optional>

#include "core/program_module.hpp"
#include "formats/file_part.hpp"
#include "scene/packed/draco_module.hpp"

namespace darkroom::scene {
namespace {

constexpr std::size_t place_of_method = 8;
constexpr std::byte sequential{0};

/// Stops between the declarations of the attributes and their values.
template <class Library>
class AdmittedMesh final : public Library {
  public:
    AdmittedMesh(std::uint64_t vertices, const AdmitVertices& admit) : vertices_(vertices), admit_(admit) {}
    [[nodiscard]] const std::optional<Error>& refusal() const { return refusal_; }

  protected:
    bool DecodeAllAttributes() override {
        if (Result<> admitted = check(*this->point_cloud()); !admitted) {
            refusal_ = admitted.error();
            return false;
        }
        return Library::DecodeAllAttributes();
    }

  private:
    [[nodiscard]] Result<> check(const draco::PointCloud& declared) const {
        if (declared.num_points() != vertices_)
            return user_error(fmt::format("has {} vertices, its accessors have {}", declared.num_points(), vertices_));
        // Each value is there as it is packed, too, and the number of a value at each vertex.
        std::uint64_t bytes = 0;
        for (std::int32_t i = 0; i < declared.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *declared.attribute(i);
            const auto size = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
            bytes += attribute.num_components() * (size + 2 * sizeof(std::int32_t)) + sizeof(std::uint32_t);
        }
        return admit_(vertices_, bytes);
    }

    std::uint64_t vertices_;
    const AdmitVertices& admit_;
    std::optional<Error> refusal_;
};

template <class T>
Result<> take_values(const draco::Mesh& mesh, const draco::PointAttribute& from, DracoAttribute& to) {
    to.values.resize(std::size_t{mesh.num_points()} * to.components * sizeof(T));
    auto* out = reinterpret_cast<T*>(to.values.data());
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point, out += to.components) {
        const draco::AttributeValueIndex value = from.mapped_index(point);
        if (value.value() >= from.size() || !from.ConvertValue<T>(value, static_cast<std::uint8_t>(to.components), out))
            return user_error(
                fmt::format("attribute {} has no value of this type for vertex {}", to.id, point.value()));
    }
    return {};
}

Result<> take_attribute(const draco::Mesh& mesh, DracoAttribute& to) {
    const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(to.id);
    if (from == nullptr) return user_error(fmt::format("has no attribute {}", to.id));
    if (from->num_components() != to.components)
        return user_error(fmt::format("attribute {} has {} components, its accessor has {}", to.id,
                                      static_cast<int>(from->num_components()), to.components));
    switch (to.number) {
        case DracoNumber::Int8:
            return take_values<std::int8_t>(mesh, *from, to);
        case DracoNumber::UInt8:
            return take_values<std::uint8_t>(mesh, *from, to);
        case DracoNumber::Int16:
            return take_values<std::int16_t>(mesh, *from, to);
        case DracoNumber::UInt16:
            return take_values<std::uint16_t>(mesh, *from, to);
        case DracoNumber::UInt32:
            return take_values<std::uint32_t>(mesh, *from, to);
        case DracoNumber::Float:
            break;
    }
    return take_values<float>(mesh, *from, to);
}

template <class Library>
Result<> unpack(std::span<const std::byte> bytes, std::uint64_t vertices, const AdmitVertices& admit,
                draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const draco::DecoderOptions options;
    AdmittedMesh<Library> library(vertices, admit);
    const draco::Status status = library.Decode(options, &buffer, &mesh);
    if (library.refusal()) return failure(*library.refusal());
    if (!status.ok()) return user_error(fmt::format("is damaged: {}", one_printable_line(status.error_msg_string())));
    return {};
}

Result<> unpack_mesh(std::span<const std::byte> bytes, std::uint64_t vertices, const AdmitVertices& admit,
                     std::span<DracoAttribute> attributes, std::vector<std::uint32_t>& corners) {
    draco::Mesh mesh;
    try {
        auto unpacked = bytes[place_of_method] == sequential
                            ? unpack<draco::MeshSequentialDecoder>(bytes, vertices, admit, mesh)
                            : unpack<draco::MeshEdgebreakerDecoder>(bytes, vertices, admit, mesh);
        if (!unpacked) return unpacked;
        for (DracoAttribute& attribute : attributes) DARKROOM_TRY(take_attribute(mesh, attribute));
    } catch (const std::exception& exception) {
        return user_error(fmt::format("is damaged: {}", one_printable_line(exception.what())));
    }
    corners.reserve(std::size_t{mesh.num_faces()} * 3);
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh.face(face)) {
            if (corner.value() >= vertices)
                return user_error(fmt::format("is damaged: triangle {} names vertex {} of {}", face.value(),
                                              corner.value(), vertices));
            corners.push_back(corner.value());
        }
    return {};
}

}  // namespace
}  // namespace darkroom::scene

extern "C" DARKROOM_MODULE_EXPORT const darkroom::scene::DracoModule* darkroom_draco() {
    static const darkroom::scene::DracoModule module{.unpack = darkroom::scene::unpack_mesh};
    return &module;
}
