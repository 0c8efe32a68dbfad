// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/report/page.h"

#include <algorithm>

#include "core/hash.h"
#include "io/formats/html_text.h"

namespace greatx::io::report {

namespace {

/// Returns the source of an inline script for a content security policy (CSP 3, section 2.3.1).
std::string hash_source(std::string_view script) {
  const std::string hex = sha256_hex(bytes_of(script));
  const auto digit = [](char c) { return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10); };
  Bytes digest;
  for (size_t i = 0; i + 1 < hex.size(); i += 2)
    digest.push_back(static_cast<std::byte>(digit(hex[i]) << 4 | digit(hex[i + 1])));
  return "'sha256-" + base64(digest) + "'";
}

}  // namespace

std::string_view page_mark() { return "<!DOCTYPE html>\n<!-- greatx report 1 -->\n"; }

size_t page_overhead() { return page_style().size() + page_script().size() + 4096; }

std::string page_of(const Json& data, const Blobs& blobs, std::vector<size_t> used) {
  std::ranges::sort(used);
  const auto rest = std::ranges::unique(used);
  used.erase(rest.begin(), rest.end());
  const std::string title = data["summary"]["title"].get<std::string>();
  const std::string script = fmt::format("\n{}", page_script());
  std::string page(page_mark());
  page += fmt::format(
      "<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src {}; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"greatx inspect --html\">\n"
      "<title>{}: greatx data set</title>\n<style>\n",
      hash_source(script), html_escaped(title));
  page += page_style();
  page += fmt::format(
      "</style></head>\n<body>\n<noscript><p>This report of the data set {} needs JavaScript. It loads "
      "nothing "
      "from elsewhere.</p></noscript>\n<div id=\"app\"></div>\n",
      html_escaped(title));
  page += "<script type=\"application/json\" id=\"data\">";
  page += json_for_script(data.dump(-1, ' ', true, Json::error_handler_t::replace));
  page += "</script>\n";
  for (const size_t number : used)
    page +=
        fmt::format("<script type=\"text/plain\" id=\"b{}\">{}</script>\n", number, base64(blobs.at(number)));
  page += "<script>" + script + "</script>\n</body></html>\n";
  return page;
}

}  // namespace greatx::io::report
