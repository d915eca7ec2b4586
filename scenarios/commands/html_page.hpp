#pragma once
// A page for a browser, all of it in one file: text, tables, pictures.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/commands/charts.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {

class HtmlPage {
 public:
  /// `mark`: said in a comment at its beginning (whose it is); may be empty.
  HtmlPage(const std::string& title, const std::string& mark);
  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// Text as it is, line by line.
  void lines(const std::string& text);
  /// The same, folded up.
  void folded(const std::string& title, const std::string& text);
  void table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);
  /// A PNG, put into the page. Errors: UserError if it cannot be read.
  void picture(const std::filesystem::path& png, const std::string& says);
  /// Charts in two columns, drawn in `folder` and put into the page; where they cannot be drawn it says why.
  void charts(const std::vector<Chart>& charts, const std::filesystem::path& folder, const std::string& says);
  /// A drawing: an element of SVG as it is, whose texts are escaped already.
  void drawing(const std::string& svg, const std::string& says);
  /// A file beside the page.
  void link(const std::string& file, const std::string& says);
  /// Errors: OutputError, and what `mayReplace` throws.
  void write(const std::filesystem::path& file, const MayReplace& mayReplace = {}) const;

  /// Text as HTML and SVG have it, in quotes too.
  static std::string escaped(const std::string& text);

 private:
  std::string title_, mark_, body_;
};

}  // namespace pitviper
