/** Goes along the planned path that a question is about: the 3D view of this page shows the arm there. */
import { Slider, Text } from '@mantine/core'
import { useEffect } from 'react'
import { endScrub, scrubPath, usePathScrub } from '../../api/pathScrub'
import { useLive } from '../../api/live'
import { lookup } from '../../document/dict'
import { isProposed, plansOf, proposedRequest } from '../../document/plannedPaths'
import classes from './PathScrubber.module.css'

export function PathScrubber() {
  const asked = useLive((s) => proposedRequest(s.control, s.nodes, s.robots)?.path)
  const robots = useLive((s) => s.robots)
  const nodes = useLive((s) => s.nodes)
  if (asked === undefined) return null
  const arms = plansOf(nodes, asked)
    .map((plan) => plan.robot)
    .filter((robot) => isProposed(lookup(robots, robot)))
  return (
    <div className={classes.scrubber}>
      {arms.map((robot) => (
        <ArmScrubber key={`${asked} ${robot}`} robot={robot} />
      ))}
    </div>
  )
}

function ArmScrubber({ robot }: { readonly robot: string }) {
  const share = usePathScrub((s) => (s.robot === robot ? s.share : 0))
  useEffect(() => endScrub, [])
  const percent = Math.round(share * 100)
  return (
    <>
      <Text size="sm">Path of {robot}</Text>
      <Slider
        className={classes.slider ?? ''}
        min={0}
        max={100}
        value={percent}
        label={null}
        thumbLabel={`Along the path of ${robot}`}
        onChange={(value) => scrubPath(robot, value / 100)}
      />
      <Text size="sm" className={classes.share ?? ''}>
        {percent} %
      </Text>
    </>
  )
}
