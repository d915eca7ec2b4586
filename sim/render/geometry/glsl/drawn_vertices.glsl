// Vertices as they are drawn: the last corner of each triangle carries its number. gl_PrimitiveID takes llvmpipe three times as long.
layout(location = 0) in vec3 position;  // body frame [m]
layout(location = 1) in uint triangleHere;
flat out uint triangle;
