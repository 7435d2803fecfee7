/** Goes along the planned path that a question is about: the 3D view of this page shows the arm there. */
import { Group, Slider, Stack, Text } from '@mantine/core'
import { useEffect } from 'react'
import { endScrub, scrubPath, usePathScrub } from '../../api/pathScrub'
import { useLive } from '../../api/live'
import { lookup } from '../../document/dict'
import { isProposed, plansOf, proposedRequest } from '../../document/plannedPaths'

export function PathScrubber() {
  const asked = useLive((s) => proposedRequest(s.control, s.nodes, s.robots)?.path)
  const robots = useLive((s) => s.robots)
  const nodes = useLive((s) => s.nodes)
  if (asked === undefined) return null
  const arms = plansOf(nodes, asked)
    .map((plan) => plan.robot)
    .filter((robot) => isProposed(lookup(robots, robot)))
  return (
    <Stack gap="xs" px="md" py="xs" bg="var(--stopped-soft)" style={{ borderTop: '1px solid var(--line)' }}>
      {arms.map((robot) => (
        <ArmScrubber key={`${asked} ${robot}`} robot={robot} />
      ))}
    </Stack>
  )
}

function ArmScrubber({ robot }: { readonly robot: string }) {
  const share = usePathScrub((s) => (s.robot === robot ? s.share : 0))
  useEffect(() => endScrub, [])
  const percent = Math.round(share * 100)
  return (
    <Group gap="md" wrap="nowrap">
      <Text size="sm">Path of {robot}</Text>
      <Slider
        flex={1}
        miw={0}
        min={0}
        max={100}
        value={percent}
        label={null}
        thumbLabel={`Along the path of ${robot}`}
        onChange={(value) => scrubPath(robot, value / 100)}
      />
      <Text size="sm" miw="3.2em" ta="end" style={{ fontVariantNumeric: 'tabular-nums' }}>
        {percent} %
      </Text>
    </Group>
  )
}
