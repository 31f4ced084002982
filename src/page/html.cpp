#include "page/html.h"

#include <fmt/format.h>

#include <cctype>

namespace calot {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') result += c;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string data_uri(const std::string& media_type, std::string_view bytes) {
  return "data:" + media_type + ";base64," + base64(bytes);
}

std::string breakable(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    result += escaped(name.substr(i, 1));
    const bool joint = name[i] == '.' || name[i] == '_';
    if (joint && i + 1 < name.size() && std::isalpha(static_cast<unsigned char>(name[i + 1])) != 0)
      result += "<wbr>";
  }
  return result;
}

std::string html(const HtmlTable& table) {
  const auto of_numbers = [&](std::size_t column) {
    return column < table.numbers.size() && table.numbers[column] == 'r' ? " class=\"n\"" : "";
  };
  const auto label_of = [&](std::size_t column) {
    return table.labelled ? fmt::format(" data-label=\"{}\"", escaped(table.heads[column])) : std::string();
  };
  std::string out = fmt::format(
      "<div class=\"wide\" role=\"region\" tabindex=\"0\" "
      "aria-label=\"{0}\"><table><caption><span>{0}</span></caption>"
      "<thead><tr>",
      escaped(table.caption));
  for (std::size_t i = 0; i < table.heads.size(); ++i)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", of_numbers(i), breakable(table.heads[i]));
  out += "</tr></thead><tbody>\n";
  for (const HtmlTable::Row& row : table.rows) {
    out += fmt::format("<tr{}>", row.attributes);
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      out += i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", of_numbers(i), row.cells[i])
                    : fmt::format("<td{}{}>{}</td>", of_numbers(i), label_of(i), row.cells[i]);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string seconds(double time) { return fmt::format("{:.2f} s", time); }

std::string figure_text(double value) { return fmt::format("{:.4g}", value); }

}  // namespace calot
