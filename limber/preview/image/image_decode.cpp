#include "limber/preview/image/image_decode.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <utility>

#include <jpeglib.h>
#include <png.h>

#include "limber/document/images.h"

namespace limber {

namespace {

bool isTooLarge(std::size_t width, std::size_t height, std::size_t fileSize) {
  constexpr std::size_t kFree = std::size_t{1} << 24, kMax = std::size_t{1} << 26;
  if (width == 0 || height == 0 || width > 65535 || height > 65535) return true;
  const std::size_t pixels = width * height;
  return pixels > kMax || (pixels > kFree && pixels / 64 > fileSize);
}

std::optional<DecodedImage> decodePng(ByteSpan file) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, file.data(), file.size())) return std::nullopt;
  if (isTooLarge(header.width, header.height, file.size())) {
    png_image_free(&header);
    return std::nullopt;
  }
  header.format = PNG_FORMAT_RGBA;  // without it, libpng would blend with a background
  Bytes rgba(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, rgba.data(), 0, nullptr)) return std::nullopt;
  DecodedImage image{{static_cast<int>(header.width), static_cast<int>(header.height), {}}, {}};
  image.colors.pixels.reserve(rgba.size() / 4 * 3);
  bool isOpaque = true;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    image.colors.pixels.insert(image.colors.pixels.end(), rgba.begin() + static_cast<std::ptrdiff_t>(i),
                               rgba.begin() + static_cast<std::ptrdiff_t>(i + 3));
    isOpaque = isOpaque && rgba[i + 3] == 255;
  }
  if (isOpaque) return image;
  image.alpha.reserve(rgba.size() / 4);
  for (std::size_t i = 3; i < rgba.size(); i += 4) image.alpha.push_back(rgba[i]);
  return image;
}

// libjpeg leaves through longjmp where a file is damaged: to readJpeg, in whose frame nothing has to be destroyed.
struct JpegReader {
  jpeg_decompress_struct info = {};
  jpeg_error_mgr errors = {};
  jpeg_progress_mgr progress = {};
  std::jmp_buf leave;

  JpegReader() = default;
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&info); }
};

[[noreturn]] void leaveJpeg(j_common_ptr info) {
  std::longjmp(static_cast<JpegReader*>(info->client_data)->leave, 1);
}

// A progressive file may go over all pixels again with every few bytes.
void stopEndlessScans(j_common_ptr info) {
  constexpr int kMaxScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMaxScans) leaveJpeg(info);
}

void ignoreMessage(j_common_ptr) {}

bool readJpeg(JpegReader& reader, ByteSpan file, Image& image) {
  jpeg_decompress_struct& info = reader.info;
  info.err = jpeg_std_error(&reader.errors);
  info.client_data = &reader;
  reader.errors.error_exit = &leaveJpeg;
  reader.errors.output_message = &ignoreMessage;
  reader.progress.progress_monitor = &stopEndlessScans;
  if (setjmp(reader.leave) != 0) return false;
  jpeg_create_decompress(&info);
  info.progress = &reader.progress;
  jpeg_mem_src(&info, file.data(), static_cast<unsigned long>(file.size()));
  jpeg_read_header(&info, TRUE);
  if (isTooLarge(info.image_width, info.image_height, file.size())) return false;
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  image.width = static_cast<int>(info.output_width);
  image.height = static_cast<int>(info.output_height);
  image.pixels.resize(std::size_t{info.output_width} * info.output_height * 3);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = image.pixels.data() + std::size_t{info.output_scanline} * info.output_width * 3;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

std::optional<DecodedImage> decodeJpeg(ByteSpan file) {
  JpegReader reader;
  Image image;
  if (!readJpeg(reader, file, image)) return std::nullopt;
  return DecodedImage{std::move(image), {}};
}

}  // namespace

std::optional<DecodedImage> decodeImage(ByteSpan file) {
  const std::string_view type = imageFormat(file).mediaType;
  if (type == "image/png") return decodePng(file);
  if (type == "image/jpeg") return decodeJpeg(file);
  return std::nullopt;
}

}  // namespace limber
