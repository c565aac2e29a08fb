// The file system that Assimp sees: the one file in memory, and what the resolver opens beside it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <assimp/IOSystem.hpp>

#include "limber/document/read.h"

namespace limber {

class ImportIo : public Assimp::IOSystem {
 public:
  // `mainName` is how Assimp knows the main file. Both views must outlive this object.
  ImportIo(ByteSpan mainFile, std::string mainName, const Resolver& resolver)
      : mainFile_(mainFile), mainName_(std::move(mainName)), resolver_(resolver) {}

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  // A side file by the path that the model or its materials give: as it is if that is relative, beside the materials'
  // file first, then beside the model; else by its last part beside the model.
  std::optional<Bytes> sideFile(std::string_view path) const;

  // The first file that was asked for beside the main one and is not there.
  const std::optional<std::string>& missingFile() const { return missingFile_; }

  // Textures of the materials' files that were opened which do not lie as they are.
  std::size_t movedTextures() const { return movedTextures_; }

 private:
  const Bytes* cached(const std::string& path) const;

  ByteSpan mainFile_;
  std::string mainName_;
  const Resolver& resolver_;
  std::vector<std::string> materialFolders_;  // of the MTL files that were opened; each once; they end with a slash
  std::size_t movedTextures_ = 0;
  std::optional<std::string> missingFile_;
  mutable std::map<std::string, std::optional<Bytes>> sideFiles_;
};

}  // namespace limber
