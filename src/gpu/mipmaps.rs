//! Mip-maps: an sRGB image and its halvings, averaged in linear light and weighed with alpha, made on the CPU so that
//! every adapter filters the same texels.

use super::device::Gpu;

/// sRGB decoding (IEC 61966-2-1), 0..1.
pub fn linear_from_srgb(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

/// Its inverse.
pub fn srgb_from_linear(c: f64) -> f64 {
    if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 }
}

/// Linear RGB times alpha, and alpha.
struct Level {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
}

impl Level {
    fn decode(image: &image::RgbaImage) -> Level {
        let table: Vec<f32> = (0..=255).map(|c| linear_from_srgb(f64::from(c) / 255.0) as f32).collect();
        let texels = image.pixels().map(|p| {
            let alpha = f32::from(p.0[3]) / 255.0;
            let [r, g, b] = [0, 1, 2].map(|i| table[p.0[i] as usize] * alpha);
            [r, g, b, alpha]
        });
        Level { width: image.width(), height: image.height(), texels: texels.collect() }
    }

    fn encode(&self) -> Vec<u8> {
        let byte = |c: f64| (c.clamp(0.0, 1.0) * 255.0).round() as u8;
        let texel = |&[r, g, b, a]: &[f32; 4]| {
            let color = [r, g, b].map(|c| byte(srgb_from_linear(f64::from(c / a.max(1e-6)))));
            [color[0], color[1], color[2], byte(f64::from(a))]
        };
        self.texels.iter().flat_map(texel).collect()
    }

    /// Half the size, rounded down; each texel is the mean of the part of this level it covers.
    fn half(&self) -> Level {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let columns: Vec<_> = (0..width).map(|x| coverage(x, self.width, width)).collect();
        let rows: Vec<_> = (0..height).map(|y| coverage(y, self.height, height)).collect();
        let mut texels = Vec::with_capacity((width * height) as usize);
        for row in &rows {
            for column in &columns {
                texels.push(self.mean(column, row));
            }
        }
        Level { width, height, texels }
    }

    fn mean(&self, columns: &[(u32, f32)], rows: &[(u32, f32)]) -> [f32; 4] {
        let mut sum = [0.0; 4];
        for &(y, row_share) in rows {
            for &(x, column_share) in columns {
                let texel = self.texels[(y * self.width + x) as usize];
                for (s, t) in sum.iter_mut().zip(texel) {
                    *s += t * row_share * column_share;
                }
            }
        }
        sum
    }
}

/// Source texels under target texel `i`, with the share of it that each covers.
fn coverage(i: u32, source: u32, target: u32) -> Vec<(u32, f32)> {
    let scale = f64::from(source) / f64::from(target);
    let (start, end) = (f64::from(i) * scale, f64::from(i + 1) * scale);
    let share = |x: u32| (end.min(f64::from(x + 1)) - start.max(f64::from(x))) / scale;
    let first = start as u32;
    let last = (end.ceil() as u32).min(source);
    (first..last).map(|x| (x, share(x) as f32)).filter(|(_, share)| *share > 0.0).collect()
}

/// Uploads the image with all its mip levels; one that is too large for the adapter is halved until it fits.
pub fn upload(gpu: &Gpu, image: &image::RgbaImage) -> wgpu::TextureView {
    let mut level = Level::decode(image);
    while level.width.max(level.height) > gpu.max_texture {
        level = level.half();
    }
    let size = wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 };
    let mip_level_count = size.max_mips(wgpu::TextureDimension::D2);
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("color texture"),
        size,
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for mip_level in 0..mip_level_count {
        write_level(gpu, &texture, mip_level, &level);
        level = level.half();
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn write_level(gpu: &Gpu, texture: &wgpu::Texture, mip_level: u32, level: &Level) {
    let target = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level,
        origin: wgpu::Origin3d::ZERO,
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * level.width), rows_per_image: None };
    let size = wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 };
    gpu.queue.write_texture(target, &level.encode(), layout, size);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_returns_every_byte() {
        for c in 0..=255u8 {
            let linear = linear_from_srgb(f64::from(c) / 255.0);
            assert_eq!((srgb_from_linear(linear) * 255.0).round() as u8, c);
        }
    }

    #[test]
    fn halving_averages_light_not_bytes() {
        let image = image::RgbaImage::from_fn(2, 2, |x, _| image::Rgba(if x == 0 { [0, 0, 0, 255] } else { [255; 4] }));
        assert_eq!(Level::decode(&image).half().encode(), [188, 188, 188, 255]);
    }

    #[test]
    fn odd_sizes_use_every_texel() {
        for (source, target) in [(5, 2), (7, 3), (3, 1), (4, 2), (1, 1)] {
            let mut covered = vec![0.0; source as usize];
            for i in 0..target {
                let parts = coverage(i, source, target);
                assert!((parts.iter().map(|p| p.1).sum::<f32>() - 1.0).abs() < 1e-6);
                parts.iter().for_each(|&(x, share)| covered[x as usize] += share);
            }
            assert!(covered.iter().all(|c| (c - target as f32 / source as f32).abs() < 1e-6));
        }
    }
}
