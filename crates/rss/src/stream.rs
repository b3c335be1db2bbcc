//! The streams of a project: their names, their purpose, and the image they belong to.

use crate::envelope::Storage;

/// Which copy of the project a stream belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ImageKind {
    /// The project itself.
    #[default]
    Main,
    /// The image last exchanged with a processor, under `ONLINEIMAGE/`. It may be of another processor model.
    Online,
    /// An automatic save, under `AUTOSAVE/`.
    Autosave,
}

impl ImageKind {
    /// All images, the main one first.
    pub const ALL: [ImageKind; 3] = [ImageKind::Main, ImageKind::Online, ImageKind::Autosave];

    /// The storage that holds the image, with its slash; empty for the main one.
    #[must_use]
    pub fn prefix(self) -> &'static str {
        match self {
            ImageKind::Main => "",
            ImageKind::Online => "ONLINEIMAGE/",
            ImageKind::Autosave => "AUTOSAVE/",
        }
    }
}

macro_rules! kinds {
    ($($(#[$doc:meta])+ $kind:ident = $name:literal, $storage:expr, $class:literal;)+) => {
        /// What a stream holds.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum StreamKind {
            $($(#[$doc])+ $kind,)+
            /// A stream of no known name, with or without an envelope.
            Other,
        }

        impl StreamKind {
            /// Every named stream.
            pub const NAMED: &'static [StreamKind] = &[$(StreamKind::$kind),+];

            /// Name of the storage (or of the stream, for those without an envelope); empty for [`StreamKind::Other`].
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(StreamKind::$kind => $name,)+ StreamKind::Other => "" }
            }

            /// How its payload is stored, `None` for streams without an envelope.
            /// RSLogix decides this by the name alone.
            #[must_use]
            pub fn storage(self) -> Option<Storage> {
                match self { $(StreamKind::$kind => $storage,)+ StreamKind::Other => None }
            }

            /// Class of the root object; empty for streams that are no archive.
            #[must_use]
            pub fn root_class(self) -> &'static str {
                match self { $(StreamKind::$kind => $class,)+ StreamKind::Other => "" }
            }
        }
    };
}

const RAW: Option<Storage> = Some(Storage::RAW);
const ZLIB: Option<Storage> = Some(Storage::ZLIB);

kinds! {
    /// Processor, program ID, project name, route.
    Processor = "PROCESSOR", RAW, "CProc";
    /// Base unit and I/O modules.
    IoConfiguration = "IO CONFIGURATION", RAW, "CIOInfo";
    /// Communication channels.
    ChannelConfiguration = "CHANNEL CONFIGURATION", RAW, "CChannelConfig";
    /// Power budget.
    PowerConfiguration = "IO MISC_POWER_CONFIGURATION", ZLIB, "CIOPwr";
    /// Data tables.
    DataFiles = "DATA FILES", ZLIB, "CDataHolder";
    /// Data tables again, each with a tail.
    ExtensionalDataFiles = "Extensional DATA FILES", ZLIB, "CDataHolder";
    /// Ladder.
    ProgramFiles = "PROGRAM FILES", ZLIB, "CProgHolder";
    /// Symbols, descriptions, comments.
    MemDatabase = "MEM DATABASE", ZLIB, "DBXMemMap";
    /// Result of the last verify: download image and memory figures.
    Compiler = "COMPILER", ZLIB, "CompilerInterface";
    /// The RSLogix version that saved the project.
    Version = "Version", ZLIB, "CVersionData";
    /// Revision counters and notes.
    RevisionNotes = "REVISION NOTES", ZLIB, "CRevision";
    /// Custom data monitors.
    CustomDataMonitors = "CUSTOM DATA MONITORS", ZLIB, "CWatchHolder";
    /// Graphical monitors (the name is spelled so).
    GraphicFiles = "GRAPIC FILES", ZLIB, "CGraphicHolder";
    /// Recipe monitors.
    RecipeFiles = "RECIPE FILES", ZLIB, "CRecipeHolder";
    /// Recipe support.
    RcpHolder = "RCP HOLDER", ZLIB, "CRCPHolder";
    /// Trend charts.
    Trends = "TRENDS", ZLIB, "CTrendHolder";
    /// Data logging.
    DataLogging = "DATALOGGING CONFIGURATION", ZLIB, "CDataLogConfiguration";
    /// Window layout.
    Workspace = "WORKSPACE", ZLIB, "CWorkSpaceManager";
    /// Print options.
    ReportOptions = "REPORT OPTIONS", RAW, "CReportOptions";
    /// Print options of later versions.
    ReportOptions5 = "VER5XUP REPORT OPTIONS", RAW, "CReportOptions";
    /// Print set-ups.
    ReportOptionSetup = "ReportOptionSetup", ZLIB, "CReportOptionsManager";
    /// Options of the PC5 conversion.
    Pc5Options = "PC5 OPTIONS", RAW, "CPC5Options";
    /// Source control.
    SourceControl = "SourceControl", ZLIB, "CSourceControlPersistantData";
    /// Help.
    ApplicationHelp = "ApplicationHelp", ZLIB, "CApplicationHelp";
    /// Twelve constant bytes, no envelope.
    Contents = "Contents", None, "";
    /// The OLE property set of the project, no envelope.
    SummaryInformation = "\u{5}SummaryInformation", None, "";
}

impl StreamKind {
    /// True for streams whose payload sits in an envelope.
    #[must_use]
    pub fn has_envelope(self) -> bool {
        self.storage().is_some()
    }

    /// The full path of this stream in an image; empty for [`StreamKind::Other`].
    #[must_use]
    pub fn path(self, image: ImageKind) -> String {
        let tail = if self.has_envelope() { "/ObjectData" } else { "" };
        match self {
            StreamKind::Other => String::new(),
            _ => format!("{}{}{tail}", image.prefix(), self.name()),
        }
    }

    /// Image and kind of the stream at a path. Names compare without case, as compound files do.
    #[must_use]
    pub fn of_path(path: &str) -> (ImageKind, StreamKind) {
        let strip = |prefix: &str| {
            let head = path.get(..prefix.len())?;
            if head.eq_ignore_ascii_case(prefix) { path.get(prefix.len()..) } else { None }
        };
        let (image, rest) = [ImageKind::Online, ImageKind::Autosave]
            .into_iter()
            .find_map(|image| Some((image, strip(image.prefix())?)))
            .unwrap_or((ImageKind::Main, path));
        let storage = rest
            .rsplit_once('/')
            .and_then(|(storage, stream)| stream.eq_ignore_ascii_case("ObjectData").then_some(storage));
        let kind = StreamKind::NAMED.iter().find(|kind| match storage {
            Some(storage) => kind.has_envelope() && storage.eq_ignore_ascii_case(kind.name()),
            None => !kind.has_envelope() && rest.eq_ignore_ascii_case(kind.name()),
        });
        (image, kind.copied().unwrap_or(StreamKind::Other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_kind() {
        for &kind in StreamKind::NAMED {
            for image in ImageKind::ALL {
                assert_eq!(StreamKind::of_path(&kind.path(image)), (image, kind));
                assert_eq!(StreamKind::of_path(&kind.path(image).to_lowercase()), (image, kind));
            }
        }
        for path in ["", "apc/x", "PROCESSOR", "é", "ONLINEIMAGE", "PROCESSOR/ObjectData/x", "X/ObjectData"] {
            assert_eq!(StreamKind::of_path(path).1, StreamKind::Other, "{path}");
        }
    }
}
