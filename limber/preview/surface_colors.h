// The colours of a model's surface, as it is drawn without light.
#pragma once

#include <span>

#include "limber/actions/transfer/vertex_colors.h"
#include "limber/preview/scene.h"

namespace limber {

// Whether the file says what colour anything of it has.
bool hasColors(const Asset& asset);

// Base colours times vertex colours times base colour textures, as makeScene has them, in their full sharpness.
class SurfaceColors {
 public:
  explicit SurfaceColors(const Character& character);

  // triangle  of the character's surface; weights of its corners, sum 1. Linear RGB.
  Vec3f at(Index triangle, const Vec3& weights) const;

  const Warnings& warnings() const { return scene_.warnings; }  // of textures that cannot be read: undrawn-textures

 private:
  Scene scene_;
};

// A PNG file of a square picture, linear RGB, rows from the top.
Bytes pngOfColors(int size, std::span<const Vec3f> pixels);

}  // namespace limber
