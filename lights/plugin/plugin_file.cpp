// ELF, 64 bit, in the byte order of this machine [TIS95]: the program headers list the loaded segments and the notes.
#include "lights/plugin/plugin_file.h"

#include <elf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "lights/plugin/plugin_stamp.h"

namespace lampyr {

namespace {

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#else
constexpr Elf64_Half kMachine = EM_NONE;  // unknown: left to the system's loader
#endif

class PluginFile {
 public:
  explicit PluginFile(const std::filesystem::path& file) : file_(file) {
    std::error_code code;
    if (!std::filesystem::exists(file, code)) Fail("expected a shared library, found no such file");
    if (std::filesystem::is_directory(file, code)) Fail("expected a shared library, found a folder");
    // Opening a pipe could block forever.
    if (!std::filesystem::is_regular_file(file, code))
      Fail("expected a shared library, found something that is no file");
    stream_.open(file, std::ios::binary);
    size_ = std::filesystem::file_size(file, code);
    if (!stream_ || code)
      Fail(std::string("expected a shared library, found a file that cannot be read: ") + std::strerror(errno));
    if (size_ == 0) Fail("expected a shared library, found an empty file");
  }

  std::optional<std::string> Stamp() {
    const Elf64_Ehdr header = ReadHeader();
    // The section table is not loaded, but it is the last part of the file: if it is missing, the file is truncated.
    if (header.e_shoff > 0) RequireUpTo(header.e_shoff, uint64_t{header.e_shnum} * header.e_shentsize);
    std::optional<std::string> stamp;
    for (Elf64_Half i = 0; i < header.e_phnum; ++i) {
      const auto segment = ReadAt<Elf64_Phdr>(header.e_phoff + uint64_t{i} * sizeof(Elf64_Phdr));
      if (segment.p_type != PT_LOAD && segment.p_type != PT_NOTE) continue;
      RequireUpTo(segment.p_offset, segment.p_filesz);
      if (segment.p_type == PT_NOTE && !stamp) stamp = FindNote(segment);
    }
    return stamp;
  }

 private:
  [[noreturn]] void Fail(const std::string& text) const {
    throw Error("the plugin \"" + file_.string() + "\": " + text);
  }

  void RequireUpTo(uint64_t offset, uint64_t count) const {
    if (offset <= size_ && count <= size_ - offset) return;
    const uint64_t end = offset + count;
    Fail("expected " + (end < offset ? "2^64" : std::to_string(end)) + " bytes at least, found " +
         std::to_string(size_) + ": its end is missing");
  }

  void ReadAt(uint64_t offset, void* bytes, size_t count) {
    RequireUpTo(offset, count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (!stream_) Fail("expected a shared library, found a file that cannot be read");
  }
  template <class Struct>
  Struct ReadAt(uint64_t offset) {
    Struct value;
    ReadAt(offset, &value, sizeof value);
    return value;
  }

  Elf64_Ehdr ReadHeader() {
    std::array<char, EI_NIDENT> ident{};
    ReadAt(0, ident.data(), std::min<size_t>(ident.size(), size_));
    if (std::memcmp(ident.data(), ELFMAG, SELFMAG) != 0)
      Fail("expected a shared library (ELF), found another kind of file");
    const auto header = ReadAt<Elf64_Ehdr>(0);
    constexpr char order = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ELFDATA2LSB : ELFDATA2MSB;
    if (ident[EI_CLASS] != ELFCLASS64 || ident[EI_DATA] != order ||
        (kMachine != EM_NONE && header.e_machine != kMachine)) {
      Fail("expected a shared library for this machine (" + std::to_string(kMachine) +
           " of ELF's, 64 bit), found one for another (" + std::to_string(header.e_machine) + ")");
    }
    if (header.e_type != ET_DYN) Fail("expected a shared library, found an ELF file of another kind");
    if (header.e_phentsize != sizeof(Elf64_Phdr)) Fail("expected a shared library, found a broken one");
    return header;
  }

  // Owner and text of each note are padded to 4 bytes, or 8 where the segment is aligned so.
  std::optional<std::string> FindNote(const Elf64_Phdr& segment) {
    const uint64_t align = segment.p_align == 8 ? 8 : 4, end = segment.p_offset + segment.p_filesz;
    const auto padded = [&](uint64_t size) { return (size + align - 1) / align * align; };
    for (uint64_t at = segment.p_offset; at + sizeof(Elf64_Nhdr) <= end;) {
      const auto note = ReadAt<Elf64_Nhdr>(at);
      at += sizeof note;
      const uint64_t owner = at, text = owner + padded(note.n_namesz);
      at = text + padded(note.n_descsz);
      if (at > end) break;
      if (note.n_type != PluginNote::kType || note.n_namesz != std::strlen(PluginNote::kOwner) + 1) continue;
      std::array<char, sizeof PluginNote::kOwner> name{};
      ReadAt(owner, name.data(), note.n_namesz);
      if (std::strcmp(name.data(), PluginNote::kOwner) != 0) continue;
      std::string found(std::min<uint64_t>(note.n_descsz, 4 * PluginStamp::kSize), '\0');
      ReadAt(text, found.data(), found.size());
      found.resize(std::strlen(found.c_str()));
      return found;
    }
    return std::nullopt;
  }

  std::filesystem::path file_;
  std::ifstream stream_;
  uint64_t size_ = 0;
};

}  // namespace

std::optional<std::string> ReadPluginStamp(const std::filesystem::path& file) {
  return PluginFile(file).Stamp();
}

}  // namespace lampyr
