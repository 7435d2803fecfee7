/** A region of the world: two corners taken with the tool or typed, and how high it reaches. */
import { Stack, Switch, Text } from '@mantine/core'
import { useState } from 'react'
import { lookup, type Dict } from '../../document/dict'
import { boxOf, roundedTo, type Vector } from '../../document/poses'
import type { PlainWizardProps } from './JointWizard'
import { TaughtArm, useArm } from './TaughtArm'
import { TaughtPoint } from './TaughtPoint'
import { useShownValue } from './useShownValue'
import { VectorFields } from '../../components/VectorFields'
import { WizardFrame } from './WizardFrame'

const SMALLEST_M = 0.001
/** How high a region without heights is shown. */
const SHOWN_M: readonly [number, number] = [0, 1]

interface Region {
  readonly center: readonly [number, number]
  readonly size: readonly [number, number]
  readonly height: readonly [number, number] | undefined
}

export function RegionWizard({ asked, jog, view, isNarrow, onClose }: PlainWizardProps) {
  const [arm, setArm] = useArm(asked.arm)
  const [region, setRegion] = useState(() => regionOf(asked.value))
  const [corners, setCorners] = useState<Dict<Vector>>({})
  const shown = region && boxOfRegion(region)
  useShownValue(arm, shown && { kind: 'box', low: shown[0], high: shown[1] })

  function setCorner(name: string, corner: Vector): void {
    const next: Dict<Vector> = { ...corners, [name]: corner }
    setCorners(next)
    const [a, b] = [lookup(next, 'first'), lookup(next, 'second')]
    if (a && b) setRegion(regionBetween(a, b, region?.height !== undefined))
  }

  const { center, size, height } = region ?? { center: [0, 0], size: [0, 0], height: undefined }
  const change = (changed: Partial<Region>) => setRegion({ center: [0, 0], size: [0, 0], height: undefined, ...region, ...changed })
  return (
    <WizardFrame
      title={`Teach ${asked.title}`}
      view={view}
      isNarrow={isNarrow}
      fault={regionFault(region)}
      onUse={() => {
        if (region) asked.onSet(written(region))
        onClose()
      }}
      onClose={onClose}
    >
      <TaughtArm arm={arm} onArm={setArm} jog={jog} />
      <Text size="xs" c="dimmed">
        Touch two opposite corners with the tool, or type the numbers.
      </Text>
      <Stack gap={6}>
        <TaughtPoint label="First corner" arm={arm} point={lookup(corners, 'first')} onChange={(each) => setCorner('first', each)} />
        <TaughtPoint label="Second corner" arm={arm} point={lookup(corners, 'second')} onChange={(each) => setCorner('second', each)} />
      </Stack>
      <Stack gap={6}>
        <VectorFields
          label="Centre"
          names={['x', 'y']}
          unit="m"
          values={center}
          onChange={([x = 0, y = 0]) => change({ center: [x, y] })}
        />
        <VectorFields
          label="Size"
          names={['x', 'y']}
          unit="m"
          minimum={0}
          values={size}
          onChange={([x = 0, y = 0]) => change({ size: [x, y] })}
        />
        <Switch
          size="xs"
          label="Only between two heights"
          checked={height !== undefined}
          onChange={(event) => change({ height: event.currentTarget.checked ? heightOf(corners) : undefined })}
        />
        {height && (
          <VectorFields
            label="Heights"
            names={['low', 'high']}
            unit="m"
            values={height}
            onChange={([low = 0, high = 0]) => change({ height: [low, high] })}
          />
        )}
      </Stack>
    </WizardFrame>
  )
}

function regionBetween(a: Vector, b: Vector, hasHeight: boolean): Region {
  const [low, high] = boxOf(a, b)
  return {
    center: roundedTo([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2]),
    size: roundedTo([high[0] - low[0], high[1] - low[1]]),
    height: hasHeight ? [low[2], high[2]] : undefined,
  }
}

function heightOf(corners: Dict<Vector>): readonly [number, number] {
  const [a, b] = [lookup(corners, 'first'), lookup(corners, 'second')]
  if (!a || !b) return SHOWN_M
  const [low, high] = boxOf(a, b)
  return [low[2], high[2]]
}

function boxOfRegion({ center: [x, y], size: [width, depth], height }: Region): readonly [Vector, Vector] {
  const [low, high] = height ?? SHOWN_M
  return [
    [x - width / 2, y - depth / 2, low],
    [x + width / 2, y + depth / 2, high],
  ]
}

function regionFault(region: Region | undefined): string | undefined {
  if (!region) return 'Take two corners, or type the numbers'
  const [width, depth] = region.size
  if (width < SMALLEST_M || depth < SMALLEST_M) return 'The corners lie on one line along an axis: the region has no area'
  return region.height && region.height[1] <= region.height[0] ? 'The high height must be above the low one' : undefined
}

function pairOf(value: unknown): readonly [number, number] | undefined {
  const [a, b] = Array.isArray(value) ? (value as unknown[]) : []
  return typeof a === 'number' && typeof b === 'number' ? [a, b] : undefined
}

function regionOf(value: unknown): Region | undefined {
  if (typeof value !== 'object' || value === null) return undefined
  const fields = value as Dict<unknown>
  const [center, size] = [pairOf(lookup(fields, 'center_m')), pairOf(lookup(fields, 'size_m'))]
  return center && size && { center, size, height: pairOf(lookup(fields, 'height_m')) }
}

function written({ center, size, height }: Region): Dict<unknown> {
  return { center_m: center, size_m: size, ...(height ? { height_m: height } : {}) }
}
