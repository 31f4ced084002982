#pragma once
// What the tests of documents read in a Markdown file: text, fenced blocks, headings, links, paragraphs.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace calot::test {

/// What stands between two fences of backticks.
struct FencedBlock {
  int line = 0;            ///< of its first fence, from 1
  std::string language;    ///< what follows that fence, such as "sh run"
  std::string text;        ///< each line with its end
  std::string introduced;  ///< the paragraph before it
};

struct MarkdownLine {
  int number = 0;  ///< from 1
  std::string text;
};

struct Markdown {
  std::filesystem::path file;
  std::vector<MarkdownLine> prose;  ///< all that is in no block; an empty line stands for each block
  std::vector<FencedBlock> blocks;
};

inline Markdown read_markdown(const std::filesystem::path& file) {
  Markdown document{file, {}, {}};
  std::ifstream in(file, std::ios::binary);
  std::string line, paragraph;
  bool inside = false, ended = false;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::size_t fence = line.find_first_not_of(' ');
    if (fence != std::string::npos && line.compare(fence, 3, "```") == 0) {
      if (!inside) document.blocks.push_back({number, line.substr(fence + 3), "", paragraph});
      inside = !inside;
      document.prose.push_back({number, ""});
    } else if (inside) {
      document.blocks.back().text += line + "\n";
    } else {
      document.prose.push_back({number, line});
      if (ended) paragraph.clear();
      ended = line.empty() && !paragraph.empty();
      if (!line.empty()) paragraph += line + "\n";
    }
  }
  return document;
}

/// A heading's anchor by GitHub's rule: small letters, no punctuation, hyphens for spaces.
inline std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : std::regex_replace(heading, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1")) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || byte >= 0x80 || c == '-' || c == '_')
      anchor += static_cast<char>(std::tolower(byte));
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

/// Of all headings; one that comes again has a number.
inline std::set<std::string> anchors_of(const Markdown& document) {
  static const std::regex heading("#{1,6} +(.*)");
  std::map<std::string, int> times;
  std::set<std::string> anchors;
  std::smatch found;
  for (const MarkdownLine& line : document.prose) {
    if (!std::regex_match(line.text, found, heading)) continue;
    const std::string anchor = anchor_of(found[1]);
    const int before = times[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

/// Where links and pictures lead, with the line they stand on; those in code are none.
inline std::vector<MarkdownLine> links_of(const Markdown& document) {
  static const std::regex code("`[^`]*`"), link(R"(\]\(([^)\s]+)\))");
  std::vector<MarkdownLine> links;
  for (const MarkdownLine& line : document.prose) {
    const std::string text = std::regex_replace(line.text, code, "");
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found)
      links.push_back({line.number, (*found)[1]});
  }
  return links;
}

/// What stands in backticks on one line.
inline std::vector<MarkdownLine> code_spans_of(const Markdown& document) {
  static const std::regex code("`([^`]+)`");
  std::vector<MarkdownLine> spans;
  for (const MarkdownLine& line : document.prose)
    for (std::sregex_iterator found(line.text.begin(), line.text.end(), code), end; found != end; ++found)
      spans.push_back({line.number, (*found)[1]});
  return spans;
}

/// Paragraphs and items of lists, each with the line it begins on; no headings and no tables.
inline std::vector<MarkdownLine> paragraphs_of(const Markdown& document) {
  static const std::regex apart(R"(\s*(#.*|\|.*)?)"), item(R"(\s*([-*]|\d+\.) .*)");
  std::vector<MarkdownLine> paragraphs;
  bool open = false;
  for (const MarkdownLine& line : document.prose) {
    if (std::regex_match(line.text, apart)) {
      open = false;
      continue;
    }
    if (!open || std::regex_match(line.text, item)) paragraphs.push_back({line.number, ""});
    paragraphs.back().text += line.text + "\n";
    open = true;
  }
  return paragraphs;
}

inline std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

}  // namespace calot::test
