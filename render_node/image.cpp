#include "render_node/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/files/atomic_file.hpp"

namespace palpate {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), reason));
}

/// libpng reports by a callback that must not return; what it says travels in the exception.
[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  fail(*static_cast<const std::filesystem::path*>(png_get_error_ptr(png)), message);
}
void on_warning(png_structp, png_const_charp) {}

void on_write(png_structp png, png_bytep data, png_size_t size) {
  if (std::fwrite(data, 1, size, static_cast<std::FILE*>(png_get_io_ptr(png))) != size)
    png_error(png, std::strerror(errno));
}
void on_flush(png_structp) {}

struct PngWriter {
  png_structp png;
  png_infop info;
  explicit PngWriter(const std::filesystem::path& file)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, const_cast<std::filesystem::path*>(&file), on_error,
                                    on_warning)),
        info(png_create_info_struct(png)) {}
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void say_software(const PngWriter& writer) {
  std::string key = "Software", software = "palpate";
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key.data();
  text.text = software.data();
  text.text_length = software.size();
  png_set_text(writer.png, writer.info, &text, 1);
}

void encode(const Image& image, const std::filesystem::path& file, std::FILE* out) {
  const PngWriter writer(file);
  png_set_write_fn(writer.png, out, on_write, on_flush);
  png_set_IHDR(writer.png, writer.info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  say_software(writer);
  png_set_compression_level(writer.png, 1);
  png_set_filter(writer.png, 0, PNG_FILTER_SUB);
  png_write_info(writer.png, writer.info);
  png_set_filler(writer.png, 0, PNG_FILLER_AFTER);
  for (int y = 0; y < image.height; ++y) png_write_row(writer.png, image.pixel(0, y));
  png_write_end(writer.png, nullptr);
}

Image finish_reading(png_image& png, const std::filesystem::path& file) {
  png.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr)) fail(file, png.message);
  return image;
}

}  // namespace

void write_png(const Image& image, const std::filesystem::path& file) {
  AtomicFile whole(file);
  File out(std::fopen(whole.handle().c_str(), "wb"));
  if (!out) fail(file, std::strerror(errno));
  encode(image, file, out.get());
  if (std::fclose(out.release()) != 0) fail(file, std::strerror(errno));
  whole.commit();
}

bool is_own_png(const std::filesystem::path& file) {
  constexpr std::size_t kText = 8 + 25 + 4;  // behind the signature, the header and the text's length
  const std::string_view said{"tEXtSoftware\0palpate", 20};
  std::string head(kText + said.size(), '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.starts_with("\x89PNG") && head.ends_with(said);
}

Image decode_png(std::string_view bytes, const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) fail(file, png.message);
  return finish_reading(png, file);
}

Image read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, file.c_str())) fail(file, png.message);
  return finish_reading(png, file);
}

}  // namespace palpate
