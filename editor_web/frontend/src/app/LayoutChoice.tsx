/** How the page of a run is laid out: to operate, to debug, or the 3D view alone; none of them while it is laid out for a question. */
import { SegmentedControl } from '@mantine/core'
import { LAYOUTS, type RunLayout } from './runLayout'

const WORDS: Record<RunLayout, string> = { operate: 'Operate', debug: 'Debug', '3d': '3D only' }

export function LayoutChoice({
  layout,
  onLayout,
}: {
  readonly layout: RunLayout | undefined
  readonly onLayout: (layout: RunLayout) => void
}) {
  return (
    <SegmentedControl
      size="xs"
      aria-label="Layout"
      value={layout ?? ''}
      onChange={(value) => onLayout(LAYOUTS.find((each) => each === value) ?? 'operate')}
      data={LAYOUTS.map((value) => ({ value, label: WORDS[value] }))}
    />
  )
}
