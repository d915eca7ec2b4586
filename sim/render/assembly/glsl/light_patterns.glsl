// What a light sends in a direction, as a share of its intensity. Its entry has two texels more: how its axes are turned from the body's (a quaternion), and
// what its pattern takes; which pattern that is stands beside its reach, 0 for none.
//@slot light_bodies
float lightPattern(int entry, vec3 inBody) {
  int kind = int(lightTexel(entry + 2).z);
  if (kind == 0) return 1.0;
  vec4 turn = lightTexel(entry + 3), parameters = lightTexel(entry + 4);
  vec3 across = cross(turn.xyz, inBody);
  vec3 direction = inBody + 2.0 * (turn.w * across + cross(turn.xyz, across));
//@slot light_kinds
  return 1.0;
}
