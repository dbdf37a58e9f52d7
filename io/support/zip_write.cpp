// SPDX-License-Identifier: Apache-2.0
#include "io/support/zip_archive.hpp"
#include "io/support/zip_format.hpp"

#include <algorithm>

namespace cadt::io::detail {
namespace {

/// A record of little-endian numbers.
class Record {
 public:
  template <class T>
  Record& add(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      text_ += static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xff);
    return *this;
  }
  Record& add_text(std::string_view text) {
    text_ += text;
    return *this;
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

constexpr std::uint16_t version_plain = 20, version_64 = 45;  // 2.0 and 4.5, as the format numbers its features
constexpr std::uint16_t first_day_of_1980 = 0x0021;           // a fixed date: equal meshes give equal files

bool is_large(std::uint64_t value) { return value >= zip::in_extra; }
std::uint32_t short_form(std::uint64_t value) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, zip::in_extra));
}

}  // namespace

void ZipWriter::add(const std::string& name, std::span<const std::string_view> parts) {
  Entry entry{name, 0, 0, position_};
  for (const std::string_view part : parts) {
    entry.crc = zip::checksum(entry.crc, part);
    entry.size += part.size();
  }
  const bool large = is_large(entry.size);
  Record record;
  record.add(zip::local_signature).add(large ? version_64 : version_plain).add<std::uint16_t>(0).add(zip::stored);
  record.add<std::uint16_t>(0)
      .add(first_day_of_1980)
      .add(entry.crc)
      .add(short_form(entry.size))
      .add(short_form(entry.size));
  record.add(static_cast<std::uint16_t>(name.size())).add<std::uint16_t>(large ? 20 : 0).add_text(name);
  if (large) record.add(zip::extra64).add<std::uint16_t>(16).add(entry.size).add(entry.size);
  out_.write(record.text());
  for (const std::string_view part : parts) out_.write(part);
  position_ += record.text().size() + entry.size;
  entries_.push_back(std::move(entry));
}

void ZipWriter::finish() {
  const std::uint64_t start = position_;
  for (const Entry& entry : entries_) {
    Record extra;
    if (is_large(entry.size)) extra.add(entry.size).add(entry.size);
    if (is_large(entry.offset)) extra.add(entry.offset);
    const auto extra_size = static_cast<std::uint16_t>(extra.text().size());
    const std::uint16_t version = extra_size != 0 ? version_64 : version_plain;
    Record record;
    record.add(zip::entry_signature).add(version).add(version).add<std::uint16_t>(0).add(zip::stored);
    record.add<std::uint16_t>(0)
        .add(first_day_of_1980)
        .add(entry.crc)
        .add(short_form(entry.size))
        .add(short_form(entry.size));
    record.add(static_cast<std::uint16_t>(entry.name.size()))
        .add(static_cast<std::uint16_t>(extra_size != 0 ? extra_size + 4 : 0));
    record.add<std::uint16_t>(0).add<std::uint16_t>(0).add<std::uint16_t>(0).add<std::uint32_t>(0);
    record.add(short_form(entry.offset)).add_text(entry.name);
    if (extra_size != 0) record.add(zip::extra64).add(extra_size).add_text(extra.text());
    out_.write(record.text());
    position_ += record.text().size();
  }
  const std::uint64_t size = position_ - start, count = entries_.size();
  Record end;
  if (is_large(start) || is_large(size)) {
    end.add(zip::end64_signature).add<std::uint64_t>(zip::end64_size - 12).add(version_64).add(version_64);
    end.add<std::uint32_t>(0).add<std::uint32_t>(0).add(count).add(count).add(size).add(start);
    end.add(zip::locator64_signature).add<std::uint32_t>(0).add(position_).add<std::uint32_t>(1);
  }
  end.add(zip::end_signature).add<std::uint16_t>(0).add<std::uint16_t>(0);
  end.add(static_cast<std::uint16_t>(count)).add(static_cast<std::uint16_t>(count));
  end.add(short_form(size)).add(short_form(start)).add<std::uint16_t>(0);
  out_.write(end.text());
}

}  // namespace cadt::io::detail
