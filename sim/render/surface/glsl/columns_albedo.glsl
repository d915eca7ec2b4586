// Every component is Lambertian: its column is its albedo / pi, which the surface reads already.
//@use sim/render/surface/glsl/lobes.glsl
Vec3 reflectionColumns(int i, int l, int v) { return 0.31830989 * hemisphericalAt(i * COMPONENT_VECTORS + v).xyz * modifier_[v]; }
