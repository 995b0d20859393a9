//! Enums whose variants are listed and have a name, each variant declared once.

/// An enum with a function that says one thing of each variant, `Variant = what it says`, and where their number is given with their list, `ALL`.
macro_rules! listed {
    (
        $(#[$about:meta])* pub enum $name:ident,
        $(#[$said:meta])* $says:ident: $type:ty { $($(#[$what:meta])* $variant:ident = $value:expr,)* }
    ) => {
        $(#[$about])*
        pub enum $name {
            $($(#[$what])* $variant,)*
        }

        impl $name {
            $(#[$said])*
            #[must_use]
            pub const fn $says(self) -> $type {
                match self {
                    $(Self::$variant => $value),*
                }
            }
        }
    };
    (
        $(#[$about:meta])* pub enum $name:ident: $count:literal,
        $(#[$said:meta])* $says:ident: $type:ty { $($(#[$what:meta])* $variant:ident = $value:expr,)* }
    ) => {
        $crate::listed::listed! {
            $(#[$about])* pub enum $name,
            $(#[$said])* $says: $type { $($(#[$what])* $variant = $value,)* }
        }

        impl $name {
            /// All of them, in order.
            pub const ALL: [Self; $count] = [$(Self::$variant),*];
        }
    };
}

pub(crate) use listed;
