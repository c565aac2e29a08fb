#include "limber/asset/import_text.h"

#include <assimp/types.h>

namespace limber {

std::string textOf(const aiString& text) {
  return validUtf8(std::string_view(text.data, text.length));
}

}  // namespace limber
