#ifndef LIMBER_CODECS

#include <fmt/format.h>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/codecs/codec_library.h"

#ifdef __EMSCRIPTEN__
#include <emscripten.h>

// The module's `codecs`, as bindings/wasm/limber.mjs describes them. Decoded meshes stay with them, by number.
// clang-format off
EM_JS(int, limber_page_has_codec, (const char* name), {
  return Module["codecs"] && Module["codecs"][UTF8ToString(name)] ? 1 : 0;
});
EM_JS(int, limber_page_meshopt, (const std::uint8_t* data, std::size_t size, std::size_t count, std::size_t stride,
                                 const char* mode, std::size_t modeSize, const char* filter, std::size_t filterSize,
                                 std::uint8_t* out), {
  const decoded = Module["codecs"]["meshopt"](HEAPU8.slice(data, data + size), count, stride,
                                              UTF8ToString(mode, modeSize), UTF8ToString(filter, filterSize));
  if (!decoded) return 0;
  HEAPU8.set(decoded, out);
  return 1;
});
EM_JS(int, limber_page_draco, (const std::uint8_t* data, std::size_t size), {
  const mesh = Module["codecs"]["draco"](HEAPU8.slice(data, data + size));
  if (!mesh) return -1;
  const meshes = Module["dracoMeshes"] = Module["dracoMeshes"] || [];
  return meshes.push(mesh) - 1;
});
EM_JS(void, limber_page_draco_free, (int mesh), {
  Module["dracoMeshes"][mesh].free();
  delete Module["dracoMeshes"][mesh];
});
EM_JS(std::size_t, limber_page_draco_faces, (int mesh), { return Module["dracoMeshes"][mesh].faces; });
EM_JS(std::size_t, limber_page_draco_points, (int mesh), { return Module["dracoMeshes"][mesh].points; });
EM_JS(void, limber_page_draco_copy_faces, (int mesh, std::uint32_t* out), {
  HEAPU32.set(Module["dracoMeshes"][mesh].indices(), out >> 2);
});
EM_JS(int, limber_page_draco_components, (int mesh, int attribute), {
  return Module["dracoMeshes"][mesh].components(attribute);
});
EM_JS(int, limber_page_draco_copy_values, (int mesh, int attribute, int type, std::uint8_t* out), {
  const values = Module["dracoMeshes"][mesh].values(attribute, type);
  if (!values) return 0;
  HEAPU8.set(values, out);
  return 1;
});
// clang-format on
#endif

namespace limber {

namespace {

[[noreturn]] void failMissing(const char* codec) {
  throw Error(ErrorCode::kUnsupported,
              fmt::format("has geometry compressed with {}, which this program does not decompress", codec), {},
              "export the model without compression");
}

}  // namespace

#ifdef __EMSCRIPTEN__

namespace {

class PageDracoMesh : public DracoMesh {
 public:
  explicit PageDracoMesh(int number) : number_(number) {}
  PageDracoMesh(const PageDracoMesh&) = delete;
  PageDracoMesh& operator=(const PageDracoMesh&) = delete;
  ~PageDracoMesh() override { limber_page_draco_free(number_); }

  std::size_t faces() const override { return limber_page_draco_faces(number_); }
  std::size_t points() const override { return limber_page_draco_points(number_); }
  void copyFaces(std::uint32_t* out) const override { limber_page_draco_copy_faces(number_, out); }

  std::optional<Index> components(int attribute) const override {
    const int count = limber_page_draco_components(number_, attribute);
    if (count <= 0) return std::nullopt;
    return static_cast<Index>(count);
  }

  bool copyValues(int attribute, ComponentType type, std::uint8_t* out) const override {
    return limber_page_draco_copy_values(number_, attribute, static_cast<int>(type), out) != 0;
  }

 private:
  int number_;
};

}  // namespace

bool decodeMeshoptData(const MeshoptData& data, std::uint8_t* out) {
  if (limber_page_has_codec("meshopt") == 0) failMissing("meshopt");
  return limber_page_meshopt(data.bytes.data(), data.bytes.size(), data.count, data.stride, data.mode.data(),
                             data.mode.size(), data.filter.data(), data.filter.size(), out) != 0;
}

// The page's decoder counts only once all is decoded; its memory is its own, and ends with what a module may have.
std::unique_ptr<DracoMesh> decodeDracoData(ByteSpan data, const DracoBounds& bounds) {
  if (limber_page_has_codec("draco") == 0) failMissing("Draco");
  const int number = limber_page_draco(data.data(), data.size());
  if (number < 0) return nullptr;
  auto mesh = std::make_unique<PageDracoMesh>(number);
  if ((bounds.faces && mesh->faces() != *bounds.faces) || mesh->points() != bounds.points) return nullptr;
  return mesh;
}

#else

bool decodeMeshoptData(const MeshoptData&, std::uint8_t*) {
  failMissing("meshopt");
}
std::unique_ptr<DracoMesh> decodeDracoData(ByteSpan, const DracoBounds&) {
  failMissing("Draco");
}

#endif

}  // namespace limber

#endif
