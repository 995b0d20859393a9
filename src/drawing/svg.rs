//! An SVG document in the making.

use glam::DVec2;

/// Ink and ground in the light and in the dark, those of a page's panels (assets/page/page.css): a page shows the picture as an image, which takes no colours from
/// it but follows its `color-scheme`. Words have a rim of the ground, as they stand on what is drawn.
const STYLE: &str = "<style>svg{color:#1b1f23;background:#f6f7f8}text{paint-order:stroke;stroke:#f6f7f8;stroke-width:4px;stroke-linejoin:round}@media (prefers-color-scheme:dark){svg{color:#e6e9ec;background:#1d2226}text{stroke:#1d2226}}</style>\n";

/// An SVG document in the making.
pub(super) struct Svg {
    text: String,
}

impl Svg {
    /// One over an image that is shown at a size.
    pub(super) fn with_image(
        ([width, height], [shown_width, shown_height]): ([usize; 2], [usize; 2]),
        name: &str,
        image: &str,
    ) -> Self {
        Self {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{name}\" font-family=\"system-ui, Arial, sans-serif\" font-size=\"16\">\n{STYLE}<image href=\"data:image/png;base64,{image}\" width=\"{shown_width}\" height=\"{shown_height}\"/>\n"
            ),
        }
    }

    /// One without an image.
    pub(super) fn plain([width, height]: [usize; 2], name: &str) -> Self {
        Self {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{name}\" font-family=\"system-ui, Arial, sans-serif\" font-size=\"16\">\n{STYLE}"
            ),
        }
    }

    pub(super) fn polygon(&mut self, corners: &[DVec2], colour: &str) {
        let points: Vec<String> = (corners.iter())
            .map(|corner| format!("{:.1},{:.1}", corner.x, corner.y))
            .collect();
        self.text += &format!(
            "<polygon points=\"{}\" fill=\"{colour}\"/>\n",
            points.join(" ")
        );
    }

    pub(super) fn disc(&mut self, at: DVec2, radius: f64, colour: &str) {
        self.text += &format!(
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{colour}\"/>\n",
            at.x, at.y
        );
    }

    pub(super) fn line(&mut self, [from, to]: [DVec2; 2], colour: &str, width: f64, opacity: f64) {
        self.text += &format!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\"",
            from.x, from.y, to.x, to.y
        );
        if opacity < 1.0 {
            self.text += &format!(" opacity=\"{opacity}\"");
        }
        self.text += "/>\n";
    }

    pub(super) fn arrow(&mut self, [from, to]: [DVec2; 2], colour: &str, width: f64) {
        let along = (to - from).normalize_or(DVec2::X);
        let aside = DVec2::new(-along.y, along.x);
        let head = 3.0 + 3.0 * width;
        let neck = to - head * along;
        self.line([from, neck], colour, width, 1.0);
        let [one, other] = [1.0, -1.0].map(|side| neck + 0.5 * side * head * aside);
        self.text += &format!(
            "<polygon points=\"{:.1},{:.1} {:.1},{:.1} {:.1},{:.1}\" fill=\"{colour}\"/>\n",
            to.x, to.y, one.x, one.y, other.x, other.y
        );
    }

    pub(super) fn dot(&mut self, at: DVec2, radius: f64) {
        self.text += &format!(
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"2\"/>\n",
            at.x, at.y
        );
    }

    pub(super) fn bar(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: &str) {
        self.text += &format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\"/>\n"
        );
    }

    /// Words of this program, in which nothing is to be escaped.
    pub(super) fn text(&mut self, [x, y]: [f64; 2], anchor: &str, words: &str) {
        self.text += &format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"currentColor\">{words}</text>\n"
        );
    }

    pub(super) fn end(self) -> String {
        self.text + "</svg>\n"
    }
}
