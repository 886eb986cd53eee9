namespace lampyr {}
