# Writes a .cpp with one function, <NAME>_shaders(), that returns {path, text} of every shader file in FILES.
set(body "")
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH path ${ROOT} ${file})
  file(READ ${file} text)
  string(APPEND body "      {\"${path}\", R\"pvglsl(${text})pvglsl\"},\n")
endforeach()
file(WRITE ${OUT} "#include \"sim/radiometry/shader_text.hpp\"\n
namespace pitviper {
std::span<const ShaderText> ${NAME}_shaders() {
  static const ShaderText texts[] = {
${body}  };
  return texts;
}
}  // namespace pitviper\n")
