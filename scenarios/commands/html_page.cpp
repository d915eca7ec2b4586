#include "scenarios/commands/html_page.hpp"

#include <openssl/evp.h>

#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

std::string base64(const std::string& bytes) {
  std::string out(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int size =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  out.resize(static_cast<std::size_t>(size));
  return out;
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:72em;padding:0 1.5em;color:#1c2330;background:#fff}"
    "h1{font-size:1.5em;margin:0 0 .3em}h2{font-size:1.15em;margin:1.8em 0 .5em;border-bottom:1px solid #d8dce3;padding-bottom:.2em}"
    "table{border-collapse:collapse;margin:.6em 0}td,th{border:1px solid #d8dce3;padding:.25em .7em;text-align:right;font-variant-numeric:tabular-nums}"
    "td:first-child,th:first-child{text-align:left}th{background:#f2f4f7;font-weight:600}pre{background:#f6f7f9;padding:.8em "
    "1em;overflow:auto;font-size:13px;white-space:pre-wrap}"
    "img{max-width:100%;height:auto;border:1px solid #d8dce3}figure{margin:.8em 0}figcaption{color:#5a6372;font-size:.9em}";

}  // namespace

std::string HtmlPage::escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

HtmlPage::HtmlPage(const std::string& title, const std::string& mark) : title_(title), mark_(mark) {}

void HtmlPage::heading(const std::string& text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }
void HtmlPage::paragraph(const std::string& text) { body_ += "<p>" + escaped(text) + "</p>\n"; }
void HtmlPage::lines(const std::string& text) { body_ += "<pre>" + escaped(text) + "</pre>\n"; }
void HtmlPage::folded(const std::string& title, const std::string& text) {
  body_ += "<details><summary>" + escaped(title) + "</summary><pre>" + escaped(text) + "</pre></details>\n";
}

void HtmlPage::table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  const auto row = [this](const std::vector<std::string>& cells, const char* tag) {
    body_ += "<tr>";
    for (const std::string& c : cells) body_ += std::string("<") + tag + ">" + escaped(c) + "</" + tag + ">";
    body_ += "</tr>\n";
  };
  body_ += "<table>\n";
  row(head, "th");
  for (const auto& r : rows) row(r, "td");
  body_ += "</table>\n";
}

void HtmlPage::picture(const std::filesystem::path& png, const std::string& says) {
  body_ += "<figure><img alt=\"" + escaped(says) + "\" src=\"data:image/png;base64," + base64(readWholeFile(png, {}, {})) + "\"><figcaption>" + escaped(says) +
           "</figcaption></figure>\n";
}

void HtmlPage::charts(const std::vector<Chart>& charts, const std::filesystem::path& folder, const std::string& says) {
  if (charts.empty()) return;
  const std::filesystem::path png = folder / ".report_charts.png";
  try {
    drawCharts(charts, 2, png);
    picture(png, says);
  } catch (const UserError& e) {
    paragraph(std::string("No charts: ") + e.what());
  }
  std::error_code ignored;
  std::filesystem::remove(png, ignored);
}

void HtmlPage::drawing(const std::string& svg, const std::string& says) {
  body_ += "<figure>" + svg + "<figcaption>" + escaped(says) + "</figcaption></figure>\n";
}

void HtmlPage::link(const std::string& file, const std::string& says) { body_ += "<p><a href=\"" + escaped(file) + "\">" + escaped(says) + "</a></p>\n"; }

void HtmlPage::write(const std::filesystem::path& file, const MayReplace& mayReplace) const {
  std::string page = "<!doctype html>\n";
  if (!mark_.empty()) {
    // A comment of HTML ends at two dashes.
    std::string mark = mark_;
    for (std::size_t at = mark.find("--"); at != mark.npos; at = mark.find("--", at)) mark.replace(at, 2, "- -");
    page += "<!-- " + mark + " -->\n";
  }
  page += "<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\"><title>" + escaped(title_) +
          "</title><style>" + kStyle + "</style></head><body>\n<h1>" + escaped(title_) + "</h1>\n" + body_ + "</body></html>\n";
  writeFileAtomically(file, page, mayReplace);
}

}  // namespace pitviper
