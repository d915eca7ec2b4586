// Bodies of one mesh as instances of one draw.
layout(std430, binding = 7) readonly buffer Instances { uint drawOfInstance[]; };
uniform int firstInstance;
flat out uint drawIndex;

uint drawnHere() {
  drawIndex = drawOfInstance[firstInstance + gl_InstanceID];
  return drawIndex;
}
