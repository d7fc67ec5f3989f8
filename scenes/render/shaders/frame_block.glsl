// Members of the uniform block Frame, for GLSL and (through GLM's type names) for C++: mat4, vec4 and uvec4 alone, so
// that both lay them out alike.
mat4 view;
mat4 projection;
mat4 view_projection;
mat4 previous_view_projection;
mat4 inverse_view_projection;
vec4 camera_position;  // world space; w: 1 perspective, 0 orthographic
vec4 camera_forward;   // world space, normalised; w: what is added to 1 for the gradients of textures, 0: no mip bias
vec4 target_size;      // pixels: width, height, 1 / width, 1 / height
vec4 planes;           // near distance, far distance, time in seconds, exposure of the finished picture
uvec4 light_counts;    // directional, point, spot, 0
uvec4 modes;           // output (Output_...), tone-maps (0 or 1), debug view (Debug_...), 0
vec4 ambient_sky;      // hemisphere from above; used where there is no environment
vec4 ambient_ground;
vec4 background;            // linear, where there is no skybox
vec4 environment_settings;  // intensity, last mip level of the prefiltered map, 0, 0
vec4 irradiance[9];         // spherical harmonics of the skybox, cosine-convolved, over pi; see render/light/environment.hpp
