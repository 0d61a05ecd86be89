//! The words of which drawing programs make ids and labels.

use std::sync::LazyLock;

use rustc_hash::FxHashSet;

/// Words that no person calls a part, with or without a number.
const ALONE: &[&str] = &[
    // Elements of SVG, as Inkscape writes them: `path123`, `g45-7`.
    "svg path rect circle ellipse polygon polyline line g image text tspan textpath flowroot flowpara flowregion defs \
     clippath clip lineargradient radialgradient namedview metadata",
    // Illustrator: `XMLID_2_`, `SVGID_1_`, `Layer_1`, `_Compound_Path_`, `Isolation_Mode`, `Clip_Group`.
    "xmlid svgid layer group compound clipping isolation isolationsmodus uuid",
    // Figma: `Vector_3`, `Frame 1`, `Mask group`, `Boolean_operation`.
    "vector union subtract intersect exclude boolean rectangle réunion vereinigung unión união unione объединение 矢量 ベクトル 合体 联集",
    // Sketch and XD: `Combined-Shape`, `Oval-Copy-2`, `Page-1`, `Fill-1`, `Trazado_12`.
    "artboard artboards combined shape oval bitmap fill stroke copy rounded symbols",
    // Affinity and CorelDRAW: `Curve`, `Curves`, `PowerClip`, `Layer_x0020_1`.
    "curve curves powerclip corel bezier",
    // The layers of OpenMoji: `color`, `line`, `color-foreground`.
    "color colour foreground supplement",
    // Krita, LibreOffice, SVG-edit, cairo, Matplotlib: `shape0`, `SlideGroup`, `svg_12`, `surface12`, `glyph0-1`.
    "glyph slidegroup id pathcollection",
    // Layers and groups in other languages.
    "ebene calque livello camada laag warstwa слой шар vrstva réteg katman taso nivell 图层 圖層 레이어 レイヤー",
    "gruppe groupe grupo gruppo groep группа grupp grupa skupina csoport ryhmä 组 组合 编组 群组 群組 그룹 グループ",
    // Shapes in other languages.
    "pfad tracé tracciato trazado caminho контур ścieżka útvonal yol 路径 路徑 패스 패스 パス",
    "rechteck rettangolo rectángulo retângulo rechthoek прямоугольник prostokąt obdélník 矩形 圆角矩形 圓角矩形 사각형 長方形 角丸長方形",
    "kreis cercle cerchio círculo круг okrąg 圆形 圓形 원 円 elipse ellisse эллипс elipsa 椭圆 橢圓 타원 楕円形 楕円",
    "linie ligne linha lijn линия 直线 直線",
    "kopie kopia copie copia cópia копия 拷贝 拷貝 副本 のコピー コピー 사본",
    "zeichenfläche disegno travail 画板 畫板 アートボード 대지 kurve courbe curva кривая 曲线 曲線",
    "beschneidungsgruppe schnittmaske クリップグループ シンボル",
];

/// Words that people use too, so that only a number beside them tells a program: `Star 1`, `Image 3`.
const WITH_NUMBERS: &[&str] = &[
    "star arrow page grid guide guides title text txt gradient cluster edge flowspan object objects obj element elements item node mesh picture img bild forme form figure objekt objet objeto oggetto linked axes legend tick contour \
     use switch symbol mask pattern marker filter stop tag style mode operation frame component instance variant slice pixel surface \
     container patch plan capa mesa tavola cesta kruh pad trace strat lag lager linea línea grup cirkel outlined part layers groups paths shapes lines points point polystar triangle regular spiral box cell base background img no nr c p",
    "étoile stern stella estrella ster звезда 星形 星 スター オブジェクト 对象 ファイル ページ 多角形 三角形 四角形 図形",
];

fn set(lists: &'static [&'static str]) -> FxHashSet<&'static str> {
    lists
        .iter()
        .flat_map(|words| words.split_whitespace())
        .collect()
}

/// Words of programs, in lower case.
pub(super) static PROGRAM_WORDS: LazyLock<FxHashSet<&'static str>> = LazyLock::new(|| set(ALONE));

/// Words of programs if a number goes with them, in lower case.
pub(super) static PROGRAM_WORDS_WITH_NUMBERS: LazyLock<FxHashSet<&'static str>> =
    LazyLock::new(|| set(WITH_NUMBERS));
