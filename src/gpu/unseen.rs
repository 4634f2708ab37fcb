//! Graphics cards that the system knows and no driver offers.

use super::adapter::{AdapterChoice, AdapterDescription, AdapterKind};
use super::error::hidden_drivers;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// A warning where the software adapter is only used because no driver offers the graphics card that the machine has, with
/// the remedy. Nothing where it was chosen by name, and on systems other than Linux.
///
/// ```
/// use mesoscope::gpu::{AdapterChoice, list_adapters, unseen_card};
///
/// assert!(unseen_card(&list_adapters()[0], &AdapterChoice::Software).is_none());
/// ```
#[must_use]
pub fn unseen_card(adapter: &AdapterDescription, choice: &AdapterChoice) -> Option<String> {
    let is_chosen = matches!(choice, AdapterChoice::Software | AdapterChoice::Named(_));
    if is_chosen || adapter.kind != AdapterKind::Software || cfg!(not(target_os = "linux")) {
        return None;
    }
    unseen_below(Path::new("/"), &adapter.name, hidden_drivers())
}

/// The same on a system with this root, where a variable of the environment hides drivers or not.
fn unseen_below(root: &Path, adapter: &str, hidden: Option<String>) -> Option<String> {
    let nodes = nodes(&root.join("dev"));
    let first = nodes.first()?;
    let shown = |path: &Path| Path::new("/").join(path.strip_prefix(root).unwrap_or(path)).display().to_string();
    let is_closed = |path: &&PathBuf| {
        File::options()
            .read(true)
            .write(true)
            .open(path)
            .is_err_and(|error| error.kind() == io::ErrorKind::PermissionDenied)
    };
    let remedy = if let Some(hidden) = hidden {
        hidden
    } else if let Some(closed) = nodes.iter().find(is_closed) {
        format!("{} cannot be opened: add the user to its group, often `render` or `video`", shown(closed))
    } else {
        let known = |beginning: &str| nodes.iter().any(|node| name_of(node).starts_with(beginning));
        match (known("nvidia"), known("dxg")) {
            (true, _) => {
                "in a container set NVIDIA_DRIVER_CAPABILITIES=all, or add `graphics` to it; elsewhere install the part of \
                 NVIDIA's driver that has Vulkan"
            }
            (_, true) => "in WSL install Mesa's driver `dzn`, or use the program for Windows",
            _ => "install its Vulkan driver: mesa-vulkan-drivers for AMD and Intel (Debian, Ubuntu, Fedora)",
        }
        .to_owned()
    };
    Some(format!(
        "there is a graphics card ({}), but no Vulkan driver offers it: `{adapter}` computes on the processor, much slower; \
         {remedy}. docs/guide/hardware.md has more; `--adapter software` chooses the processor",
        shown(first)
    ))
}

/// The last part of a path.
fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Files by which programs reach graphics cards: of NVIDIA, of AMD, those of the host of WSL, and of all whose drivers are in
/// the kernel.
fn nodes(devices: &Path) -> Vec<PathBuf> {
    let is_card =
        |name: &str, beginning: &str| name.strip_prefix(beginning).is_some_and(|rest| rest.parse::<u32>().is_ok());
    let listed = |folder: PathBuf, beginning: &'static str| {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        let mut found: Vec<PathBuf> = paths.filter(|path| is_card(&name_of(path), beginning)).collect();
        found.sort();
        found
    };
    let others = ["kfd", "dxg"].map(|name| devices.join(name)).into_iter().filter(|path| path.exists());
    let cards = listed(devices.to_owned(), "nvidia").into_iter().chain(others);
    cards.chain(listed(devices.join("dri"), "renderD")).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_card_that_no_driver_offers_is_named_with_the_remedy() {
        let warning = |files: &[&str], hidden: Option<&str>| {
            let root = tempfile::tempdir().unwrap();
            for file in files {
                let path = root.path().join(file);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, "").unwrap();
            }
            unseen_below(root.path(), "llvmpipe", hidden.map(str::to_owned))
        };
        let nvidia = warning(&["dev/nvidiactl", "dev/nvidia0", "dev/dri/renderD128"], None).unwrap();
        assert!(nvidia.starts_with("there is a graphics card (/dev/nvidia0)"), "{nvidia}");
        assert!(nvidia.contains("NVIDIA_DRIVER_CAPABILITIES") && nvidia.contains("`llvmpipe`"), "{nvidia}");
        let amd = warning(&["dev/kfd", "dev/dri/renderD128"], None).unwrap();
        assert!(amd.contains("(/dev/kfd)") && amd.contains("mesa-vulkan-drivers"), "{amd}");
        let intel = warning(&["dev/dri/card0", "dev/dri/renderD128"], None).unwrap();
        assert!(intel.contains("(/dev/dri/renderD128)") && intel.contains("mesa-vulkan-drivers"), "{intel}");
        let wsl = warning(&["dev/dxg"], None).unwrap();
        assert!(wsl.contains("(/dev/dxg)") && wsl.contains("dzn"), "{wsl}");
        let hidden = warning(&["dev/dri/renderD128"], Some("the variable VK_DRIVER_FILES hides it")).unwrap();
        assert!(hidden.contains("VK_DRIVER_FILES") && !hidden.contains("mesa-vulkan-drivers"), "{hidden}");
        // A control node without a card, and a display without rendering, compute nothing.
        assert_eq!(warning(&["dev/nvidiactl", "dev/nvidia-uvm", "dev/dri/card0"], None), None);
        assert_eq!(warning(&[], None), None);
    }
}
