// SPDX-License-Identifier: MIT
// The picture is encoded; the layer is encoded, too, and premultiplied after that.

vec4 ui_composite(vec4 color, Pixel pixel, UiComposite parameters) {
    vec4 layer = ui_composite_second(pixel);
    float opacity = clamp(parameters.ui_opacity, 0.1, 1.0);
    float weight = clamp(layer.a * opacity * (1.0 - parameters.additive), 0.0, 1.0);
    vec3 light = layer.rgb * (opacity * mix(1.0, 0.7, parameters.additive));
    // An opaque interface is its own bits, whatever lies behind.
    vec3 behind = weight < 1.0 ? color.rgb * (1.0 - weight) : vec3(0.0);
    return vec4(behind + light, color.a * (1.0 - weight) + weight);
}
