//! `reports.csv` and `reports.json`: what rules reported, per feature and in total. In: statistics per feature. Out: the
//! bytes of a file. Features stand in their own order, reports by name.

use serde::Serialize;

use crate::interpreter::reports::{Report, Reports, groups};

/// The name of the sums over all features.
const TOTAL: &str = "total";

/// What the rules of one scene reported, in the state *before*.
#[derive(Clone, Debug, Default)]
pub struct SceneReports {
    pub scene: String,
    /// By the feature's name; those that reported nothing are left out.
    pub features: Vec<(String, Vec<Report>)>,
}

/// A line of the table.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    feature: &'a str,
    #[serde(flatten)]
    numbers: Numbers,
}

#[derive(Serialize)]
struct Numbers {
    report: String,
    #[serde(rename = "type")]
    kind: &'static str,
    count: u64,
    sum: f64,
    average: f64,
    min: f64,
    max: f64,
}

impl From<&Report> for Numbers {
    fn from(r: &Report) -> Self {
        let (report, kind, average) = (r.name.to_string(), r.kind.name(), r.average());
        Numbers { report, kind, count: r.count, sum: r.sum, average, min: r.min, max: r.max }
    }
}

impl SceneReports {
    /// Sums over all features, in their order.
    pub fn totals(&self) -> Vec<Report> {
        let mut totals = Reports::default();
        self.features.iter().for_each(|(_, reports)| totals.merge(reports));
        totals.into_list()
    }
}

/// Whether any rule reported anything.
pub fn any(scenes: &[SceneReports]) -> bool {
    scenes.iter().any(|scene| !scene.features.is_empty())
}

/// Columns `scene,feature,report,type,count,sum,average,min,max`; the sums of a scene and of its groups of reports have
/// the feature `total` and stand last.
pub fn to_csv(scenes: &[SceneReports]) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let written = "writing to memory cannot fail";
    writer
        .write_record(["scene", "feature", "report", "type", "count", "sum", "average", "min", "max"])
        .expect(written);
    for scene in scenes {
        let totals = with_groups(scene.totals());
        let lines = scene.features.iter().map(|(feature, reports)| (feature.as_str(), reports));
        for (feature, reports) in lines.chain([(TOTAL, &totals)]) {
            for Numbers { report, kind, count, sum, average, min, max } in reports.iter().map(Numbers::from) {
                let numbers = [sum, average, min, max].map(|x| x.to_string());
                let words = [&scene.scene, feature, &report, kind, &count.to_string()].map(str::to_owned);
                writer.write_record(words.iter().chain(&numbers)).expect(written);
            }
        }
    }
    writer.into_inner().expect(written)
}

/// A list of lines with the same fields as the columns of [`to_csv`].
pub fn to_json(scenes: &[SceneReports]) -> Vec<u8> {
    let mut lines = Vec::new();
    for scene in scenes {
        for (feature, reports) in &scene.features {
            let line = |r| Line { scene: &scene.scene, feature, numbers: Numbers::from(r) };
            lines.extend(reports.iter().map(line));
        }
        let totals = with_groups(scene.totals());
        lines.extend(totals.iter().map(|r| Line { scene: &scene.scene, feature: TOTAL, numbers: Numbers::from(r) }));
    }
    let mut bytes = serde_json::to_vec_pretty(&lines).expect("names and finite numbers serialise");
    bytes.push(b'\n');
    bytes
}

fn with_groups(totals: Vec<Report>) -> Vec<Report> {
    let groups = groups(&totals);
    totals.into_iter().chain(groups).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpreter::reports::ReportKind;

    fn report(name: &str, count: u64, sum: f64) -> Report {
        Report { name: name.into(), kind: ReportKind::Float, count, sum, min: 1.0, max: 2.5 }
    }

    fn scenes() -> Vec<SceneReports> {
        let features = vec![
            ("way/7".to_owned(), vec![report("area.roof", 2, 3.5), report("say \"hi\", you", 1, 1.0)]),
            ("way/9".to_owned(), vec![report("area.roof", 1, 0.25)]),
        ];
        vec![SceneReports { scene: "town".to_owned(), features }]
    }

    #[test]
    fn tables_have_a_line_per_feature_and_totals() {
        let csv = String::from_utf8(to_csv(&scenes())).expect("text");
        let expected = "\
scene,feature,report,type,count,sum,average,min,max
town,way/7,area.roof,float,2,3.5,1.75,1,2.5
town,way/7,\"say \"\"hi\"\", you\",float,1,1,1,1,2.5
town,way/9,area.roof,float,1,0.25,0.25,1,2.5
town,total,area.roof,float,3,3.75,1.25,1,2.5
town,total,\"say \"\"hi\"\", you\",float,1,1,1,1,2.5
town,total,area.*,group,3,3.75,1.25,1,2.5
";
        assert_eq!(csv, expected);
    }

    #[test]
    fn json_holds_the_same_lines() {
        let json: serde_json::Value = serde_json::from_slice(&to_json(&scenes())).expect("JSON");
        let lines = json.as_array().expect("a list");
        assert_eq!(lines.len(), 6);
        let expected = serde_json::json!({ "scene": "town", "feature": "total", "report": "area.*", "type": "group",
            "count": 3, "sum": 3.75, "average": 1.25, "min": 1.0, "max": 2.5 });
        assert_eq!(lines[5], expected);
        assert!(!any(&[]) && any(&scenes()));
    }
}
