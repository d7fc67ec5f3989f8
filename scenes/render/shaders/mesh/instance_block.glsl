// One Instance of the storage buffer; see frame_block.glsl.
mat4 world;
mat4 previous_world;
uvec4 links;  // material, first joint or ~0, first weight, count of weights
uvec4 morph;  // first vec4 of the morph deltas, vertices a target, 1 if mirrored, 0
