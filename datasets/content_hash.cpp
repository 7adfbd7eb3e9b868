#include "datasets/content_hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "datasets/session_file.h"
#include "datasets/text.h"

namespace legible {
namespace {

std::string Sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("OpenSSL cannot compute SHA-256");
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

// As sha256sum prints it.
std::string ChecksumLine(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::filesystem::path name = file.lexically_normal().lexically_proximate(folder.lexically_normal());
  return fmt::format("{}  {}\n", Sha256(ReadBytes(file)), name.generic_string());
}

// Each in its own folder.
std::string ChecksumLines(const std::vector<std::filesystem::path>& files) {
  std::string lines;
  for (const std::filesystem::path& file : files) lines += ChecksumLine(file, file.parent_path());
  return lines;
}

}  // namespace

std::string ContentHash(const std::vector<std::filesystem::path>& files) {
  return Sha256(ChecksumLines(files));
}

std::string ContentHash(const Session& session, const std::vector<std::filesystem::path>& more) {
  if (session.files.empty()) throw std::invalid_argument("the session was not read from files");
  std::string lines;
  for (const std::filesystem::path& file : session.files) lines += ChecksumLine(file, session.folder);
  for (const SessionImage& image : session.images) lines += ChecksumLine(image.file, session.folder);
  return Sha256(lines + ChecksumLines(more));
}

}  // namespace legible
