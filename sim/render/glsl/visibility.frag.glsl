layout(location = 0) out uvec2 identity;  // draw (0 is the background), triangle
flat in uint drawIndex;
uniform int firstTriangle;

void main() { identity = uvec2(drawIndex, uint(firstTriangle + gl_PrimitiveID)); }
