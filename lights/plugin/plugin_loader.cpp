#include "lights/plugin/plugin_loader.h"

#include <cxxabi.h>
#include <dlfcn.h>

#include <cstdlib>
#include <memory>

#include "lights/plugin/plugin_api.h"
#include "lights/plugin/plugin_file.h"

namespace lampyr {

namespace {

class PluginLoader {
 public:
  explicit PluginLoader(const std::filesystem::path& file)
      : file_(file), name_("the plugin \"" + file.string() + "\"") {}

  Plugin Load() {
    CheckStamp();
    const PluginTypes& types = *Ask(Resolve(Open()));
    if (types.lights.empty() && types.filters.empty()) Fail("expected types of lights or filters, found none");
    Plugin plugin{file_, types.lights, types.filters};
    for (LightType& type : plugin.lights) Check(type, "a light");
    for (FilterType& type : plugin.filters) Check(type, "a filter");
    return plugin;
  }

 private:
  [[noreturn]] void Fail(const std::string& text) const { throw Error(name_ + ": " + text); }

  void CheckStamp() const {
    const std::optional<std::string> stamp = ReadPluginStamp(file_);
    const std::string expected = std::string("expected the ABI \"") + kPluginStamp.text + "\", found ";
    if (!stamp)
      Fail(expected + "a shared library without a stamp of lampyr's: it is no plugin (LAMPYR_PLUGIN is missing)");
    if (*stamp != kPluginStamp.text) Fail(expected + "\"" + *stamp + "\": build it against this lampyr");
  }

  // Resolves all symbols now, so that a missing one is reported here instead of ending the process at its first call.
  void* Open() const {
    // Called through a volatile pointer: dlopen is declared not to throw, and without it an exception of a static
    // constructor would end the process here. The path is absolute, because a bare name would be searched among the
    // system libraries.
    void* (*const volatile open)(const char*, int) = dlopen;
    void* library = nullptr;
    try {
      library = open(std::filesystem::absolute(file_).c_str(), RTLD_NOW | RTLD_LOCAL);
    } catch (const std::exception& error) {
      throw LoaderBroken(
          name_ + ": expected a library that can be loaded, found static constructors that throw: " + error.what());
    } catch (...) {
      throw LoaderBroken(name_ + ": expected a library that can be loaded, found static constructors that throw");
    }
    if (!library) Fail(Explain(dlerror()));
    return library;
  }

  static std::string Explain(const std::string& message) {
    const std::string undefined = "undefined symbol: ";
    const size_t at = message.find(undefined);
    if (at == std::string::npos) return "expected a library that can be loaded, found: " + message;
    std::string symbol = message.substr(at + undefined.size());
    symbol = symbol.substr(0, symbol.find_first_of(" ,\t"));
    int status = -1;
    const std::unique_ptr<char, void (*)(void*)> readable(
        abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), std::free);
    return "expected only symbols that this lampyr has, found the undefined symbol " +
           (status == 0 ? std::string(readable.get()) : symbol);
  }

  PluginEntryPoint Resolve(void* library) const {
    void* symbol = dlsym(library, kPluginEntryPoint);
    if (!symbol) Fail(std::string("expected the entry point \"") + kPluginEntryPoint + "\", found none");
    return reinterpret_cast<PluginEntryPoint>(symbol);
  }

  const PluginTypes* Ask(PluginEntryPoint entry) const {
    const std::string expected = "expected types from its entry point, found ";
    const PluginTypes* types = nullptr;
    try {
      types = entry();
    } catch (const std::exception& error) {
      Fail(expected + "an exception: " + error.what());
    } catch (...) {
      Fail(expected + "something thrown that is no exception");
    }
    if (!types) Fail(expected + "null");
    return types;
  }

  template <class Type>
  void Check(Type& type, const char* what) const {
    if (type.name.empty()) Fail(std::string("expected a name for ") + what + ", found an empty one");
    if (!type.create) Fail("expected a factory for \"" + type.name + "\", found null");
    if (const std::string mistake = MistakeIn(type); !mistake.empty()) Fail(std::string(what) + " " + mistake);
    type.create = Guarded(std::move(type.create), what);
  }

  // The factory, with every exception and a null result turned into an Error.
  template <class Made, class Build>
  auto Guarded(std::function<std::unique_ptr<Made>(const ParameterList&, const Build&)> create,
               const char* what) const {
    return [create = std::move(create), what = std::string(what), name = name_](const ParameterList& parameters,
                                                                                const Build& build) {
      const auto fail = [&](const std::string& found) {
        throw Error(parameters.Where(), parameters.Owner() + " of " + name + ": expected " + what + ", found " + found);
      };
      std::unique_ptr<Made> made;
      try {
        made = create(parameters, build);
      } catch (const Error& error) {
        if (error.Where().file) throw;
        fail("an error: " + error.Text());
      } catch (const std::exception& error) {
        fail(std::string("an exception: ") + error.what());
      } catch (...) {
        fail("something thrown that is no exception");
      }
      if (!made) fail("null");
      return made;
    };
  }

  std::filesystem::path file_;
  std::string name_;
};

}  // namespace

Plugin LoadPlugin(const std::filesystem::path& file) {
  return PluginLoader(file).Load();
}

}  // namespace lampyr
