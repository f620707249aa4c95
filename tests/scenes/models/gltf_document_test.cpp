#include "scenes/models/gltf_document.h"

#include "tests/scenes/bodies/bending_bar.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::gltf_document_test {
namespace {

/// Eight bytes 0 ... 7 and a view of six of them from 1 on, two apart.
const std::string bytes =
    R"("asset":{"version":"2.0"},"buffers":[{"byteLength":8,"uri":"data:application/octet-stream;base64,AAECAwQFBgc="}],
"bufferViews":[{"buffer":0,"byteOffset":1,"byteLength":6,"byteStride":2},{"buffer":0,"byteLength":8}])";

std::vector<double> numbers_of(const std::string& accessor, std::size_t components) {
    const TestFolder folder;
    return GltfDocument(folder.write("a.gltf", "{" + bytes + ",\"accessors\":[" + accessor + "]}")).numbers(0, components);
}

std::string fault_of(const std::string& accessor, std::size_t components = 1) {
    const std::string text = message_of([&] { numbers_of(accessor, components); });
    return text.substr(text.find(": ") + 2);
}

}  // namespace

TEST_CASE("An accessor's numbers lie a stride apart, of every type, as fractions of the largest where they are normalized") {
    CHECK(numbers_of(R"({"bufferView":0,"componentType":5121,"count":3,"type":"SCALAR"})", 1) == std::vector<double>{1, 3, 5});
    CHECK(numbers_of(R"({"bufferView":0,"byteOffset":2,"componentType":5123,"count":2,"type":"SCALAR"})", 1) ==
          std::vector<double>{0x0403, 0x0605});
    CHECK(numbers_of(R"({"bufferView":1,"componentType":5121,"count":2,"type":"VEC3"})", 3) ==
          std::vector<double>{0, 1, 2, 3, 4, 5});
    CHECK(numbers_of(R"({"bufferView":1,"componentType":5120,"normalized":true,"count":2,"type":"SCALAR"})", 1) ==
          std::vector<double>{0.0, 1.0 / 127.0});
    CHECK(numbers_of(R"({"componentType":5126,"count":2,"type":"VEC2"})", 2) == std::vector<double>(4, 0.0));
}

TEST_CASE("A sparse accessor changes some elements") {
    CHECK(numbers_of(R"({"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR","sparse":{"count":2,
"indices":{"bufferView":1,"byteOffset":2,"componentType":5121},"values":{"bufferView":1,"byteOffset":6}}})",
                     1) == std::vector<double>{0, 1, 6, 7, 4, 5});
    CHECK(fault_of(R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR","sparse":{"count":2,
"indices":{"bufferView":1,"byteOffset":2,"componentType":5121},"values":{"bufferView":1,"byteOffset":6}}})") ==
          "a sparse index is out of range");
}

TEST_CASE("What is outside of a buffer, or claims more than there is, is refused") {
    CHECK(fault_of(R"({"bufferView":0,"componentType":5121,"count":4,"type":"SCALAR"})") ==
          "an accessor of 4 elements is outside of its buffer view");
    CHECK(fault_of(R"({"bufferView":1,"byteOffset":18446744073709551615,"componentType":5121,"count":1,"type":"SCALAR"})") ==
          "byteOffset 18446744073709551615 is out of range 0 ... 9007199254740991");
    CHECK(fault_of(R"({"bufferView":1,"byteOffset":7,"componentType":5126,"count":1,"type":"SCALAR"})") ==
          "an accessor of 1 elements is outside of its buffer view");
    CHECK(fault_of(R"({"bufferView":2,"componentType":5121,"count":1,"type":"SCALAR"})") ==
          "bufferViews: 2 is out of range 0 ... 1");
    CHECK(fault_of(R"({"componentType":5126,"count":4294967296,"type":"SCALAR"})")
              .starts_with("accessor 0 claims 4294967296 elements"));
    CHECK(fault_of(R"({"componentType":5127,"count":1,"type":"SCALAR"})") ==
          "an accessor is of type \"SCALAR\" of 5127, which is not read");
    CHECK(fault_of(R"({"componentType":5126,"count":1,"type":"VEC3"})") == "accessor 0 has 3 numbers an element, not 1");
    CHECK(fault_of(R"({"componentType":5126,"count":-1,"type":"SCALAR"})") == "count is -1, no whole number");
    CHECK(fault_of(R"({"componentType":5126,"count":1.5,"type":"SCALAR"})") == "count is 1.5, no whole number");
}

TEST_CASE("Buffers are beside the file, in it as base64, or in a GLB; one that is cut off is refused") {
    const TestFolder folder;
    folder.write("a b.bin", "12345678");
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8,"uri":"a%20b.bin"}]})";
    CHECK(GltfDocument(folder.write("a.gltf", text)).buffer_bytes() == 8);
    folder.write("a b.bin", "1234567");
    CHECK(message_of([&] { GltfDocument(folder.path("a.gltf")); }).ends_with("buffer 0 has 7 bytes, not 8"));
    const auto refused = [&](const std::string& buffers) {
        return message_of(
            [&] { GltfDocument(folder.write("b.gltf", R"({"asset":{"version":"2.0"},"buffers":)" + buffers + "}")); });
    };
    CHECK(refused(R"([{"byteLength":8,"uri":"none.bin"}])").ends_with("none.bin is no file"));
    CHECK(refused(R"([{"byteLength":8,"uri":"/dev/zero"}])").ends_with("/dev/zero is no file"));
    CHECK(refused(R"([{"byteLength":8,"uri":"data:;base64,????"}])").ends_with("a buffer's data is not base64"));
    CHECK(refused(R"([{"byteLength":8}])").ends_with("buffer 0 has no uri"));
    std::string glb = "glTF";
    const std::string json = R"({"buffers":[{"byteLength":4}]}  )";
    for (const std::uint32_t word :
         {2u, 12u + 8u + static_cast<unsigned>(json.size()) + 12u, static_cast<unsigned>(json.size()), 0x4E4F534Au})
        append_bytes(glb, word);
    glb += json;
    for (const std::uint32_t word : {4u, 0x004E4942u, 7u}) append_bytes(glb, word);
    CHECK(GltfDocument(folder.write("a.glb", glb)).buffer_bytes() == 4);
    for (std::size_t cut = 4; cut < glb.size(); ++cut) {
        CAPTURE(cut);
        CHECK_FALSE(message_of([&] { GltfDocument(folder.write("cut.glb", glb.substr(0, cut))); }).empty());
    }
}

}  // namespace percale::scenes::test::gltf_document_test
