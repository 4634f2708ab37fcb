//! Tables whose length follows from the bonds, angles or chains of a scene: described by the plan, generated on upload.

use crate::families::{Angles, Bonds, ChainGroup};

/// What a table holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Table {
    /// Words about species and kinds, then the ends and the kind of each bond, as `shaders/bonds/bonds.wgsl` reads them.
    Bonds {
        /// What comes before the bonds.
        head: Vec<u32>,
        /// The bonds.
        bonds: Bonds,
    },
    /// Words about species, then the ends of each angle and the impulse of its stiffness in half a step.
    Angles {
        /// What comes before the angles.
        head: Vec<u32>,
        /// The angles.
        angles: Angles,
        /// The impulse of each kind of angles, bits of `f32`.
        impulses: Vec<u32>,
    },
    /// Partners that do not repel each particle, in rows of equal length, padded with the particle itself.
    Exclusions {
        /// The bonds.
        bonds: Bonds,
        /// Number of particles.
        particles: u64,
        /// Length of a row.
        width: u64,
    },
    /// The first particle of each chain, its length and the number of its group.
    Chains(Vec<ChainGroup>),
}

impl Table {
    /// Its length.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Contents, Hardware, Options, plan};
    ///
    /// let scene = mesoscope::scene::load("polymer-melt", &[])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// let tables: Vec<_> = plan.buffers.iter().filter(|buffer| matches!(buffer.contents, Contents::Table(_))).collect();
    /// for buffer in &tables {
    ///     let Contents::Table(table) = &buffer.contents else { unreachable!() };
    ///     assert_eq!(table.bytes().len() as u64, table.length());
    ///     assert!(table.length() <= buffer.bytes);
    /// }
    /// assert!(tables.len() >= 2);
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn length(&self) -> u64 {
        let words = match self {
            Self::Bonds { head, bonds } => bonds.count().saturating_mul(4).saturating_add(head.len() as u64),
            Self::Angles { head, angles, .. } => angles.count().saturating_mul(4).saturating_add(head.len() as u64),
            Self::Exclusions { particles, width, .. } => particles.saturating_mul(*width),
            Self::Chains(groups) => 4 * groups.iter().map(|group| u64::from(group.chains)).sum::<u64>(),
        };
        words.saturating_mul(4)
    }

    /// What it holds.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        bytemuck::cast_slice(&self.words()).to_vec()
    }

    fn words(&self) -> Vec<u32> {
        match self {
            Self::Bonds { head, bonds } => {
                let bonds = bonds.iter().flat_map(|bond| [bond.ends[0], bond.ends[1], bond.kind, 0]);
                head.iter().copied().chain(bonds).collect()
            }
            Self::Angles { head, angles, impulses } => {
                let angles = angles.iter().flat_map(|angle| {
                    let [first, middle, last] = angle.ends;
                    [first, middle, last, impulses[angle.kind as usize]]
                });
                head.iter().copied().chain(angles).collect()
            }
            Self::Exclusions { bonds, particles, width } => exclusions(bonds, *particles as usize, *width as usize),
            Self::Chains(groups) => {
                let of_group = |(number, group): (u32, &ChainGroup)| {
                    let group = *group;
                    (0..group.chains).flat_map(move |chain| [group.first + chain * group.beads, group.beads, number, 0])
                };
                (0..).zip(groups).flat_map(of_group).collect()
            }
        }
    }
}

fn exclusions(bonds: &Bonds, particles: usize, width: usize) -> Vec<u32> {
    let mut rows: Vec<u32> = (0..particles as u32).flat_map(|id| std::iter::repeat_n(id, width)).collect();
    for bond in bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion) {
        let [a, b] = bond.ends;
        for (end, partner) in [(a, b), (b, a)] {
            let row = &mut rows[end as usize * width..(end as usize + 1) * width];
            if !row.contains(&partner)
                && let Some(free) = row.iter_mut().find(|entry| **entry == end)
            {
                *free = partner;
            }
        }
    }
    rows
}
