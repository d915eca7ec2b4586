// Meshes of the scene: per vertex (position, u), (normal, v); three indices a triangle.
layout(std430, binding = 0) readonly buffer Vertices { vec4 vertices[]; };
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };
