#include "process/loaded_code.h"

#include <elf.h>
#include <link.h>

#include <cstring>

#include "base/digest.h"
#include "session/build_info.h"

namespace calot {
namespace {

/// The build id among the notes of a segment; empty: there is none.
std::string_view build_id(const char* notes, std::size_t size) {
  const auto padded = [](std::size_t length) { return (length + 3) / 4 * 4; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes, sizeof note);
    const std::size_t name = sizeof note, text = name + padded(note.n_namesz);
    if (text + note.n_descsz > size) break;
    if (note.n_type == NT_GNU_BUILD_ID &&
        std::string_view(notes + name, note.n_namesz) == std::string_view("GNU", 4))
      return {notes + text, note.n_descsz};
    const std::size_t whole = std::min(size, text + padded(note.n_descsz));
    notes += whole, size -= whole;
  }
  return {};
}

std::string_view build_id(const dl_phdr_info& object) {
  for (int k = 0; k < object.dlpi_phnum; ++k) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[k];
    if (segment.p_type != PT_NOTE) continue;
    // The system tells where a segment lies as a number.
    const auto* notes = reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr);
    if (const std::string_view id = build_id(notes, segment.p_memsz); !id.empty()) return id;
  }
  return {};
}

struct Found {
  Digest digest;
  bool program = false;  ///< has been seen: it comes first
  bool known = true;
};

int take_object(dl_phdr_info* object, std::size_t, void* to) {
  Found& found = *static_cast<Found*>(to);
  const std::string_view id = build_id(*object);
  if (!found.program) found.known = !id.empty();
  found.program = true;
  found.digest.add(std::string_view(object->dlpi_name));
  found.digest.add(id);
  return 0;
}

}  // namespace

std::string loaded_code() {
  Found found;
  dl_iterate_phdr(take_object, &found);
  if (!found.program || !found.known) return {};
  found.digest.add(std::string_view(to_text(this_make())));
  return found.digest.hex();
}

}  // namespace calot
