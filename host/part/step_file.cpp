#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Shape.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <exception>
#include <mutex>
#include <sstream>
#include <string_view>

#include "host/part/brep.hpp"

namespace pinjaw::part {
namespace {

/// OpenCASCADE keeps its settings, messages and STEP parser in global state.
std::mutex& reader_lock() {
  static std::mutex lock;
  return lock;
}

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

std::string product_name(const Handle(StepBasic_ProductDefinition) & definition) {
  if (definition.IsNull() || definition->Formation().IsNull()) return {};
  const Handle(StepBasic_Product) product = definition->Formation()->OfProduct();
  return product.IsNull() ? std::string() : text_of(product->Name());
}

/// The name of the product whose occurrence in an assembly made `solid`; empty for a part that is no
/// assembly.
std::string occurrence_name(const STEPControl_Reader& reader, const TopoDS_Shape& solid) {
  const Handle(Standard_Transient) made_by = reader.WS()->TransferReader()->EntityFromShapeResult(solid, 1);
  const auto occurrence = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(made_by);
  return occurrence.IsNull() ? std::string() : product_name(occurrence->RelatedProductDefinition());
}

std::string only_product_name(const STEPControl_Reader& reader) {
  const Handle(StepData_StepModel) model = reader.StepModel();
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (!product.IsNull()) return text_of(product->Name());
  }
  return {};
}

std::vector<NamedShape> solids_of(const STEPControl_Reader& reader, const TopoDS_Shape& shape) {
  std::vector<NamedShape> solids;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    solids.push_back({occurrence_name(reader, it.Current()), std::make_shared<TopoDS_Shape>(it.Current())});
  }
  if (solids.size() == 1 && solids.front().name.empty()) solids.front().name = only_product_name(reader);
  return solids;
}

/// CAD systems leave names out; nothing here follows them. Any other mistake leaves a reference to nothing or
/// a number unset, and transferring those would read memory that is not there.
bool is_harmless(std::string_view mistake) {
  return mistake.find("not a quoted String") != std::string_view::npos;
}

/// The first mistake that the parser found in the file's entities; empty where there is none.
std::string first_mistake(const STEPControl_Reader& reader) {
  const Handle(StepData_StepModel) model = reader.StepModel();
  for (Standard_Integer entity = 1; entity <= model->NbEntities(); ++entity) {
    const Handle(Interface_Check) check = model->Check(entity, true);
    for (Standard_Integer i = 1; i <= check->NbFails(); ++i) {
      const std::string mistake = check->CFail(i);
      if (is_harmless(mistake)) continue;
      return "entity #" + std::to_string(model->IdentLabel(model->Value(entity))) + ": " + mistake;
    }
  }
  return {};
}

constexpr std::string_view kFirstWords = "ISO-10303-21";
constexpr std::string_view kLastWords = "END-ISO-10303-21";
constexpr std::size_t kHeadBytes = 1024;  // comments may stand before the first words

base::Expected<std::vector<NamedShape>> read_checked(const std::string& text, const std::string& file) {
  const std::lock_guard guard(reader_lock());
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  std::istringstream stream(text);
  if (reader.ReadStream(file.c_str(), stream) != IFSelect_RetDone) {
    return base::failure(file + ": the STEP file is broken: it cannot be parsed");
  }
  if (const std::string mistake = first_mistake(reader); !mistake.empty()) {
    return base::failure(file + ": the STEP file is broken: " + mistake);
  }
  if (reader.TransferRoots() == 0) {
    return base::failure(file + ": the STEP file holds no shape that can be read");
  }
  std::vector<NamedShape> solids = solids_of(reader, reader.OneShape());
  if (solids.empty()) {
    return base::failure(file + ": no solid in the STEP file; surfaces alone do not make a part");
  }
  return solids;
}

}  // namespace

base::Expected<std::vector<NamedShape>> read_step(const std::string& text, const std::string& file) {
  if (text.empty()) return base::failure(file + ": the file is empty");
  if (std::string_view(text).substr(0, kHeadBytes).find(kFirstWords) == std::string_view::npos) {
    return base::failure(file + ": not a STEP file: it does not begin with ISO-10303-21");
  }
  if (std::string_view(text).find(kLastWords) == std::string_view::npos) {
    return base::failure(file + ": the STEP file is cut short: END-ISO-10303-21 is missing");
  }
  try {
    return read_checked(text, file);
  } catch (const Standard_Failure& reason) {
    return base::failure(file + ": the STEP file is broken: " + reason.GetMessageString());
  } catch (const std::exception& reason) {
    return base::failure(file + ": the STEP file is broken: " + reason.what());
  }
}

}  // namespace pinjaw::part
